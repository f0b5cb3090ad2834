"""The README's example of the package, run as it stands there."""

import math
import os
import re
from pathlib import Path


def test_the_example_of_the_readme_runs_and_its_lifetimes_are_numbers() -> None:
    readme = Path(os.environ["SPINNEB_CONFIGS"]).parent / "README.md"
    [example] = [block for block in re.findall(r"```python\n(.*?)```", readme.read_text("utf-8"), flags=re.S) if "import spinneb" in block]
    names: dict = {}
    *lines, last = example.strip().splitlines()
    exec("\n".join(lines), names)
    assert names["result"].certified
    lifetimes = eval(last, names)
    assert len(lifetimes) > 0 and all(t > 0.0 and math.isfinite(t) for t in lifetimes), lifetimes
