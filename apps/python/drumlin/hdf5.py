"""Files of HDF5 as the programs write them (docs/formats/snapshot.md)."""

import zlib

import h5py
import numpy as np

from .figures import whole_file


def write_hdf5(path, content, words=None):
    """A file of numbers, arrays and texts by the names of their datasets, whole or not at all; `words`: unit and description of each name."""
    with h5py.File("image", "w", driver="core", backing_store=False) as file:
        for name, value in content.items():
            if isinstance(value, str):
                value = np.array(value.encode(), h5py.string_dtype("utf-8", len(value.encode())))
            dataset = file.create_dataset(name, data=value)
            for key, text in zip(("unit", "description"), (words or {}).get(name, ())):
                dataset.attrs.create(key, text, dtype=h5py.string_dtype("utf-8", len(text.encode())))
        file.flush()
        image = file.id.get_file_image()
    with whole_file.aside(path) as stream:
        stream.write(image)
        stream.write(b"DRUMLCRC" + zlib.crc32(image).to_bytes(4, "little"))
