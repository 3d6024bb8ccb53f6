from .population import Population as Population
