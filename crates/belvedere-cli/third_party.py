"""Prints the licences of all crates that the program contains, with their texts. Usage: third_party.py TARGET"""

import json
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TEXTS = ("licen", "copying", "notice", "unlicense", "copyright")


def of_cargo(*words):
    return subprocess.run(["cargo", *words], cwd=ROOT, check=True, capture_output=True, text=True).stdout


def texts(folder):
    """The files of a crate that are texts of licences."""
    return sorted(path for path in folder.iterdir() if path.is_file() and path.name.lower().startswith(TEXTS))


def main(target):
    listed = of_cargo("tree", "-p", "belvedere-cli", "-e", "normal", "--target", target, "--prefix", "none", "--locked", "--format", "{p}")
    contained = {tuple(line.split()[:2]) for line in listed.splitlines() if line.strip()}
    packages = json.loads(of_cargo("metadata", "--format-version", "1", "--locked", "--filter-platform", target))["packages"]
    print("The program belvedere contains these crates. Their licences follow.\n")
    found = [p for p in packages if p["source"] and (p["name"], f"v{p['version']}") in contained]
    for package in found:
        print(f"{package['name']} {package['version']}: {package['license']}")
    # many crates have the same text
    by_text = {}
    for package in found:
        folder = Path(package["manifest_path"]).parent
        files = texts(folder)
        if not files and package["authors"]:
            by_text.setdefault(f"By {', '.join(package['authors'])}.", []).append(package["name"])
        for file in files:
            by_text.setdefault(file.read_text("utf-8", "replace").strip(), []).append(package["name"])
    for text, names in by_text.items():
        print(f"\n{'=' * 100}\n{', '.join(dict.fromkeys(names))}\n\n{text}")


main(sys.argv[1])
