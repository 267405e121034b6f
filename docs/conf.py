"""The documentation as a site: `docs/build-site OUT` (needs the package, sphinx, myst-parser and numpydoc)."""

import belvedere

project = "Belvedere"
author = "The Belvedere developers"
release = belvedere.__version__
extensions = ["myst_parser", "numpydoc", "sphinx.ext.autodoc", "sphinx.ext.mathjax"]
source_suffix = {".md": "markdown"}
exclude_patterns = ["notebooks", "upstream.md"]
html_theme = "alabaster"
html_theme_options = {"page_width": "1100px", "description": "What can be seen from where, directly on point clouds"}
myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 3
numpydoc_show_class_members = False
autodoc_member_order = "bysource"
autodoc_typehints = "none"
autosummary_generate = False
# links of pages to files of the repository, which are no part of the site
suppress_warnings = ["myst.xref_missing", "myst.header"]
