"""The pages as a site: README.md, CONTRIBUTING.md, CHANGELOG.md, docs/ and the references of C++ and
Python. scripts/site.sh runs Sphinx with it; the source folder is that of the repository.

What the pages need beside their Markdown is done here, so that they stay plain files:
- README.md gets the table of contents and is index.html too.
- A link to a folder leads to the section's page, or becomes plain text where there is none.
- Displayed formulae keep their numbers.
- MathJax is copied beside the pages, from Debian's libjs-mathjax: no network.
"""
import __future__
import gc
import os
import re
import shutil
import sys
import types
from pathlib import Path

from docutils import nodes

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "docs/site"), str(ROOT / "python")]
import cpp_reference  # noqa: E402

MATHJAX = Path("/usr/share/javascript/mathjax")
SECTIONS = {"docs/guide": "guide", "docs/theory": "theory", "docs/formats": "formats",
            "docs/develop": "develop", "docs/validation": "validation",
            "include/asdic": "cpp", "python/asdic": "python"}

gc.disable()  # a third of the time goes into looking for garbage; all of it is 350 MB

project = "asdic"
author = "asdic developers"
copyright = "asdic developers, BSD 3-Clause licence"  # noqa: A001  Sphinx's name
release = re.search(r"project\(asdic VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text())[1]

extensions = ["myst_parser", "breathe", "sphinx.ext.autodoc", "sphinx.ext.napoleon",
              "sphinx.ext.mathjax"]
root_doc = "README"
include_patterns = ["README.md", "CONTRIBUTING.md", "CHANGELOG.md", "docs/*.md", "docs/site/*.rst", "docs/**/*.md"]
exclude_patterns = ["build*", "_skbuild", "out", ".git", "tests", "scripts", "scenarios"]
html_theme = "furo"
html_title = f"asdic {release}"
html_static_path = ["static"]
html_css_files = ["asdic.css"]
html_copy_source = False
html_show_sphinx = False
smartquotes = False  # quotes are as they are in the files
pygments_style, pygments_dark_style = "default", "monokai"

myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 4
myst_dmath_double_inline = True
mathjax_path = "mathjax/MathJax.js?config=TeX-AMS_SVG"
myst_update_mathjax = False
mathjax2_config = {"showMathMenu": False, "messageStyle": "none",
                   "tex2jax": {"processClass": "math"},  # the pages themselves are left alone
                   "SVG": {"linebreaks": {"automatic": True, "width": "container"}}}

XML = Path(os.environ.get("ASDIC_SITE_XML", ROOT / "build/site/xml"))
breathe_projects = {"asdic": str(XML)}
breathe_default_project = "asdic"
breathe_default_members = ("members",)
breathe_show_include = False
cpp_id_attributes = ["ASDIC_API"]

autodoc_member_order = "bysource"
autodoc_typehints = "none"
napoleon_numpy_docstring = True
default_role = "code"

CONTENTS = """
```{toctree}
:hidden:
:titlesonly:

docs/site/guide
docs/site/python
docs/site/cpp
docs/site/formats
docs/site/theory
docs/site/validation
docs/site/develop
docs/STATUS
docs/performance
docs/glossary
CONTRIBUTING
CHANGELOG
```
"""


def load_stub(name, path):
    """A module of its types alone, in place of the extension: the reference needs no build."""
    module = types.ModuleType(name)
    flags = __future__.annotations.compiler_flag
    exec(compile(path.read_text(), path, "exec", flags), module.__dict__)  # noqa: S102
    sys.modules[name] = module


def links_to_folders(text, docname):
    """A link to a folder: to its section, or its words alone."""
    here = (ROOT / docname).parent

    def changed(found):
        words, target = found.groups()
        folder = os.path.normpath(here / target)
        if re.match(r"\w+:", target) or not os.path.isdir(folder):
            return found.group()
        section = SECTIONS.get(os.path.relpath(folder, ROOT))
        if section is None:
            return words
        return f"[{words}]({os.path.relpath(ROOT / 'docs/site' / section, here)}.md)"

    return re.sub(r"(?<!!)\[([^\]]*)\]\(([^)#\s]+)\)", changed, text)


def read(app, docname, source):
    source[0] = links_to_folders(source[0], docname)
    if docname == root_doc:
        source[0] += CONTENTS
    elif docname == "docs/site/cpp":
        source[0] += cpp_reference.page(ROOT / "include/asdic", XML)


def keep_numbers(app, doctree):
    """\\tag is an error in what Sphinx puts around a formula of several lines."""
    for formula in doctree.findall(nodes.math_block):
        formula["nowrap"] = True
        formula[:] = [nodes.Text(f"\\[{formula.astext()}\\]")]


def finish(app, exception):
    if exception or app.builder.name != "html":
        return
    out = Path(app.outdir)
    shutil.copyfile(out / "README.html", out / "index.html")
    parts = ["MathJax.js", "config/TeX-AMS_SVG.js", "extensions", "jax/element", "jax/input/TeX",
             "jax/output/SVG/autoload", "jax/output/SVG/fonts/TeX", "jax/output/SVG/jax.js",
             "jax/output/SVG/config.js"]
    for part in parts:
        to = out / "_static/mathjax" / part
        to.parent.mkdir(parents=True, exist_ok=True)
        if (MATHJAX / part).is_dir():
            shutil.copytree(MATHJAX / part, to, dirs_exist_ok=True)
        else:
            shutil.copyfile(MATHJAX / part, to)


def setup(app):
    load_stub("asdic._core", ROOT / "python/asdic/_core.pyi")
    app.connect("source-read", read)
    app.connect("doctree-read", keep_numbers)
    app.connect("build-finished", finish)
