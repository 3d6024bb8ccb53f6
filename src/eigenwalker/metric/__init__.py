"""How different two walks are: maps, registration, loops and distances (Pražák et al. 2010)."""
