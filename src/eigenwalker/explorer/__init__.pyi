from .interactive_page import interactive_page as interactive_page
from .model import page_model as page_model
from .widget import WalkerWidget as WalkerWidget, show as show
