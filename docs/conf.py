"""The documentation as a site: `docs/build-site OUT` (needs the package `belvedere` and the packages that `build-site` names)."""

import re

import belvedere

project = "Belvedere"
author = "The Belvedere developers"
release = belvedere.__version__
extensions = [
    "myst_nb",
    "numpydoc",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.mathjax",
    "sphinx_copybutton",
    "sphinx_design",
]
exclude_patterns = ["upstream.md", "_templates"]
templates_path = ["_templates"]

html_theme = "furo"
html_title = "Belvedere"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_copy_source = False
html_show_sourcelink = False
html_show_copyright = False
html_theme_options = {
    "light_css_variables": {"color-brand-primary": "#1f5fa8", "color-brand-content": "#1f5fa8"},
    "dark_css_variables": {"color-brand-primary": "#8ab8f0", "color-brand-content": "#8ab8f0"},
}

myst_enable_extensions = ["dollarmath", "colon_fence"]
myst_heading_anchors = 3
# notebooks are kept with their outputs; tests run them
nb_execution_mode = "off"
# a button copies the command without the prompt
copybutton_prompt_text = r">>> |\.\.\. |\$ "
copybutton_prompt_is_regexp = True

numpydoc_show_class_members = False
autodoc_member_order = "bysource"
autodoc_typehints = "none"
# a page for each function and class, below `reference`, which is made again each time and not kept
autosummary_generate = True
autosummary_generate_overwrite = True
# links of pages to files of the repository, which are no part of the site
suppress_warnings = ["myst.xref_missing", "myst.header"]


def link_pages(app, what, name, obj, options, lines):
    """Docstrings name pages of the repository: here they are links."""
    lines[:] = [re.sub(r"docs/([\w/-]+)\.md", r":doc:`/\1`", line) for line in lines]


def link_notes(app, docname, source):
    """Links to the research notes lead to their copies in the site, and back."""
    if docname.startswith("notes/"):
        source[0] = source[0].replace("](../../docs/", "](/")
    else:
        source[0] = re.sub(r"\]\((\.\./)+research/notes/", "](/notes/", source[0])


def setup(app):
    app.connect("autodoc-process-docstring", link_pages)
    app.connect("source-read", link_notes)
