"""Print the lowest versions that pyproject.toml declares, one requirement a line."""

import tomllib
from pathlib import Path

project = tomllib.loads(Path("pyproject.toml").read_text(encoding="utf-8"))["project"]
extras = project["optional-dependencies"]
declared = [*project["dependencies"], *extras["notebook"], *extras["test"]]
print(
    *[each.replace(">=", "==") for each in declared if not each.startswith("eigenwalker")], sep="\n"
)
