"""Pages that play a stimulus in a browser and ask nothing of anybody else."""

from eigenwalker.page.stand_alone import stand_alone_page as stand_alone_page
