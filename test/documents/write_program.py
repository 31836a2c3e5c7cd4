"""write_program.py DOCUMENT START FILE: writes the indented block of a document that begins with START into a file."""
import pathlib
import re
import sys

document, start, path = sys.argv[1:]
blocks = re.findall(r"(?:^(?:    .*)?\n)+", pathlib.Path(document).read_text(encoding="utf-8"), flags=re.MULTILINE)
texts = [re.sub("^    ", "", block, flags=re.MULTILINE).strip() + "\n" for block in blocks]
found = [text for text in texts if text.startswith(start)]
if len(found) != 1:
    sys.exit(f"{document}: {len(found)} blocks begin with '{start}'")
pathlib.Path(path).write_text(found[0], encoding="utf-8")
