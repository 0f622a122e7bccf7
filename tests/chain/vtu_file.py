"""Arrays of VTK's XML files, decoded as VTK does."""

import base64
import struct
import xml.etree.ElementTree
import zlib

import numpy

from command import require

TYPES = {"Float32": "<f4", "Float64": "<f8", "Int32": "<i4", "UInt8": "<u1"}


def content_of(text, form):
    """Bytes of one array: sizes of its blocks, encoded by themselves, and then the blocks."""
    letters = lambda count: (count * struct.calcsize(form) + 2) // 3 * 4
    blocks, size, rest = struct.unpack(f"<3{form}", base64.b64decode(text[:letters(3)]))
    if not blocks:  # as VTK writes an empty array; it ends here
        require(rest == 0, f"no block, and one of {rest} bytes")
        return b""
    packed = struct.unpack(f"<4{form}", base64.b64decode(text[:letters(4)]))[3]
    raw = zlib.decompress(base64.b64decode(text[letters(4):letters(4) + (packed + 2) // 3 * 4], validate=True))
    require(blocks == 1 and rest in (0, size) and len(raw) == size, f"{blocks} blocks, {size} and {rest} bytes, {len(raw)} found")
    return raw


def arrays_of(file):
    """Every array of a .vtu file of one piece by its name; sizes as the file itself says."""
    root = xml.etree.ElementTree.parse(file).getroot()
    require(root.get("type") == "UnstructuredGrid" and root.get("compressor") == "vtkZLibDataCompressor", f"{file}: {root.attrib}")
    form = {"UInt32": "I", "UInt64": "Q"}[root.get("header_type", "UInt32")]
    piece = root.find("UnstructuredGrid/Piece")
    points, cells = int(piece.get("NumberOfPoints")), int(piece.get("NumberOfCells"))
    appended = root.findtext("AppendedData", "").strip()
    require(appended[:1] in ("", "_"), f"{file}: no underscore before the appended data")
    arrays = {}
    for parent in piece:
        for element in parent:
            name = "Points" if parent.tag == "Points" else element.get("Name")
            text = appended[1 + int(element.get("offset")):] if element.get("format") == "appended" else element.text.strip()
            width = int(element.get("NumberOfComponents", 1))
            values = numpy.frombuffer(content_of(text, form), TYPES[element.get("type")])
            values = values.reshape(-1, width) if width > 1 else values
            if name != "connectivity":
                count = points if parent.tag in ("Points", "PointData") else cells
                require(len(values) == count, f"{file}: {element.attrib}: {len(values)} entries instead of {count}")
            arrays[name] = values
    ends = arrays["offsets"]
    require(len(arrays["connectivity"]) == (ends[-1] if len(ends) else 0), f"{file}: cells of another size than their points")
    require(not len(arrays["connectivity"]) or arrays["connectivity"].max() < points, f"{file}: points that do not exist")
    return arrays
