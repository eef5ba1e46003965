"""documents_have.py ROOT PROGRAM: each picture of the documents is a figure of the table and is there; no other picture is
there; gallery.md is its page."""
from load_figures import *
import plot
text = open(os.path.join(root, "doc", "gallery.md"), encoding="utf-8").read()
assert text == figures.page(), "doc/gallery.md is out of date: run scripts/figures.py"
missing = set(plot.PICTURES) - set(re.findall(r"plot\.py (\w+) ", text))
assert not missing, f"kinds of figures that are not in the gallery: {missing}"
shown = set()
for path in ["README.md", *(f"doc/{name}" for name in os.listdir(os.path.join(root, "doc")) if name.endswith(".md"))]:
    with open(os.path.join(root, path), encoding="utf-8") as file:
        pictures = re.findall(r"!\[[^]]*\]\(([^)]*)\)", file.read())
    shown |= {os.path.relpath(os.path.join(root, os.path.dirname(path), name), figures.FOLDER) for name in pictures}
there = {os.path.relpath(os.path.join(at, name), figures.FOLDER) for at, _, names in os.walk(figures.FOLDER) for name in names if name.endswith((".png", ".gif"))}
made = {figures.file_of(name) for name in figures.TABLE}
assert shown <= made and made == there, (shown - made, made ^ there)
sizes = [os.path.getsize(os.path.join(figures.FOLDER, name)) for name in made if name.startswith("gallery/")]
assert len(sizes) > 20 and max(sizes) <= figures.GALLERY_BYTES, sizes
assert os.path.getsize(os.path.join(figures.FOLDER, "moving.gif")) <= figures.MOVING_BYTES
