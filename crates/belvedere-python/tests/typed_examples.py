"""Writes the code of docs/python.md, tutorials and notebooks as modules, for mypy: `typed_examples.py FOLDER`."""

from __future__ import annotations

import json
import re
import sys
from pathlib import Path

DOCS = Path(__file__).parents[3] / "docs"


def main() -> None:
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    code = {}
    for path in [DOCS / "python.md", *sorted((DOCS / "tutorials").glob("*.md"))]:
        blocks = re.findall(r"```python\n(.*?)```", path.read_text(encoding="utf-8"), re.DOTALL)
        code[f"page_{path.stem}"] = "\n".join(blocks)
    for path in sorted((DOCS / "notebooks").glob("*.ipynb")):
        cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
        code[f"notebook_{path.stem}"] = "\n\n".join(
            "".join(cell["source"]) for cell in cells if cell["cell_type"] == "code"
        )
    assert len(code) >= 6
    for name, text in code.items():
        (folder / f"{name}.py").write_text(text + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
