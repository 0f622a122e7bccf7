"""README and the pages of results show what the files in data/ say: their tables, and every relative link; the glossary is that of the pages and messages.

usage: results.py SOURCE_DIR
"""

import pathlib
import re
import subprocess
import sys
import tempfile

SOURCE = pathlib.Path(sys.argv[1])
TABLES = SOURCE / "apps" / "pages" / "result_tables.py"
ISOLATED = [sys.executable, "-I", "-B", str(SOURCE / "apps" / "figures" / "isolated.py"), str(TABLES)]
PAGES = [SOURCE / "README.md", *sorted((SOURCE / "docs" / "results").glob("*.md"))]


def call(*words):
    return subprocess.run([*ISOLATED, *map(str, words)], capture_output=True, text=True)


def check_the_tables():
    found = call("--check", *PAGES)
    assert found.returncode == 0, found.stdout + found.stderr
    shown = [name for page in PAGES for name in re.findall(r"<!-- table ([^>]*) -->", page.read_text())]
    known = re.findall(r'^    "([^"]+)": \w', TABLES.read_text(), re.MULTILINE)
    assert len(known) > 5 and sorted(shown) == sorted(known), (shown, known)


def check_that_a_changed_number_is_found():
    with tempfile.TemporaryDirectory() as folder:
        page = pathlib.Path(folder) / "page.md"
        page.write_text(re.sub(r"(\| flow rate Q \| )21\.8", r"\g<1>21.9", PAGES[0].read_text()))
        found = call("--check", page)
        assert found.returncode == 1 and "21.9" in found.stdout and "21.8" in found.stdout, found.stdout
        assert call(page).returncode == 0 and page.read_text() == PAGES[0].read_text()


def check_links():
    """Of every page of the documentation: the file that a link names is there."""
    missing = []
    for page in [SOURCE / "README.md", SOURCE / "CONTRIBUTING.md", SOURCE / "data" / "README.md", *sorted((SOURCE / "docs").rglob("*.md"))]:
        text = re.sub(r"```.*?```", "", page.read_text(), flags=re.DOTALL)
        for target in re.findall(r"\]\(([^)\s]+)\)", text):
            if re.match(r"[a-z]+:", target):
                continue
            name, _, anchor = target.partition("#")
            file = page.parent / name if name else page
            if not file.exists():
                missing.append(f"{page.relative_to(SOURCE)}: {target}")
            elif anchor and file.suffix == ".md" and anchor not in anchors(file):
                missing.append(f"{page.relative_to(SOURCE)}: {target} (no such heading)")
    assert not missing, "links that lead nowhere:\n" + "\n".join(missing)


def anchors(page):
    """As GitHub makes them of headings: lower case, spaces to hyphens, all but letters, digits, hyphens and underscores left out."""
    text = re.sub(r"```.*?```", "", page.read_text(), flags=re.DOTALL)
    headings = re.findall(r"^#+ +(.*)$", text, flags=re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-") for heading in headings}


def check_the_glossary():
    """Every term is used on some page, and no page uses a word that was dropped for one."""
    pages = {str(page.relative_to(SOURCE / "docs")): re.sub(r"```.*?```|`[^`]*`", "", page.read_text(), flags=re.DOTALL).lower() for page in (SOURCE / "docs").rglob("*.md")}
    terms = [term for line in re.findall(r"^- \*\*([^*]*)\*\*", pages.pop("glossary.md"), re.MULTILINE) for term in line.split(", ")]
    unused = [term for term in terms if not any(term in text for text in pages.values())]
    dropped = [f"{name}: {word}" for name, text in pages.items() for word in re.findall(r"\b(?:stands(?! for)|asks for|march|manieth|hangs on|axes that remember)\b", text)]
    assert len(terms) > 50 and not unused and not dropped, (unused, dropped)


def check_the_messages():
    """No text that a program prints uses a word that was dropped; "march" is a value of flow.json."""
    dropped = re.compile(r"\b(?:stands?(?! for)|asks? for|asked for|manieth|not told|hangs on|marche[sd]|marching)\b")
    found = []
    for folder in ("apps", "coupling", "continuum", "particles"):
        for source in sorted(path for path in (SOURCE / folder).rglob("*") if path.suffix in (".cpp", ".hpp")):
            code = re.sub(r"^\s*//.*$", "", source.read_text(), flags=re.MULTILINE)
            found += [f"{source.relative_to(SOURCE)}: {text}" for text in re.findall(r'"((?:[^"\\\n]|\\.)*)"', code) if dropped.search(text)]
    assert not found, found


check_the_tables()
check_the_messages()
check_that_a_changed_number_is_found()
check_links()
check_the_glossary()
