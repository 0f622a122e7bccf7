"""Files of strangers: whatever they hold is read or refused with an error of ours. The corpora of tests/fuzz, mutated from a fixed seed."""

import random
import struct
import warnings
import zlib

import drumlin
import h5py
import numpy as np
import pytest
from conftest import SOURCES

TYPES = {"double": np.float64, "float": np.float32, "int": np.int32, "long": np.int64}
PIECES = ["0", "-1", "1e308", "-1e-320", "nan", "inf", "2.7", "2147483648", "9223372036854775807", "1" * 5000, "null", "true", "{", "}", "[", "]", "\"",
          "'", "\\", ".", ",", "=", ":", "#", "\n", "\t", " ", "*", "\N{BYTE ORDER MARK}", "\0", "[[", "\"\"\"", "$", "/", "../", "[" * 3000, "{\"a\":" * 3000,
          "# ", "\udcff", "# format = \n", "int", "long", "text", "double", "float", "grains/", "fields/", "\x1b[2J", "1_000", "0x1F", "1979-05-27"]


def changed(text, others, draw):
    """One change, as tests/fuzz/driver.cpp makes them."""
    at, length = draw.randint(0, len(text)), draw.randrange(400 if draw.random() < 0.1 else 12)
    other, piece = draw.choice(others), draw.choice(PIECES)
    kind = draw.randrange(5)
    if kind == 0:
        return text[:at] + text[at + length:]
    if kind == 1:
        return text[:at] + text[at:at + length] + text[at:]
    if kind == 2:
        begin = draw.randint(0, len(other))
        return text[:at] + other[begin:begin + length] + text[at:]
    if kind == 3:
        return text[:at] + piece + text[at:]
    begin = next((k for k in range(at, len(text)) if text[k].isdigit()), len(text))
    end = next((k for k in range(begin, len(text)) if text[k] not in "0123456789.e+-"), len(text))
    return text[:begin] + piece + text[end:]


def mutations(texts, count, seed):
    draw = random.Random(seed)
    yield from texts
    for _ in range(count):
        text = draw.choice(texts)
        for _ in range(draw.randint(1, 4)):
            text = changed(text, texts, draw)
        yield text


def sealed(path):
    """With the checksum of our files at its end (coupling/core/hdf5/h5_handles)."""
    stored = path.read_bytes()
    path.write_bytes(stored + TRAILER_WORD + struct.pack("<I", zlib.crc32(stored)))


def numbers(words):
    for word in words:
        try:
            yield float(word)
        except ValueError:
            return


def write_described(path, text, seal=True):
    """Lines of name, type and numbers, as tests/fuzz/h5_recipe.hpp says."""
    with h5py.File(path, "w") as file:
        for line in text.splitlines():
            name, kind, *words = [*line.split(), "", ""]
            try:
                if kind in TYPES:
                    with np.errstate(all="ignore"):
                        file.create_dataset(name, data=np.array(list(numbers(words)), float).astype(TYPES[kind]))
                elif kind == "text":
                    content = line.split(None, 2)[2].replace("\\n", "\n").encode()
                    file.create_dataset(name, data=np.frombuffer(content, np.uint8))
            except (ValueError, IndexError, OSError):  # twice, or a name that HDF5 does not take
                pass
    if seal:
        sealed(path)


def read_or_refused(path):
    try:
        found = drumlin.read(path)
    except drumlin.DrumlinError as error:
        assert str(error)
        return 0
    assert found is not None
    return 1


def corpus(*names):
    texts = [file.read_text(encoding="utf-8", errors="surrogateescape") for name in names for file in sorted((SOURCES / "tests/fuzz/corpus" / name).iterdir())]
    return [text for text in texts if not text.startswith("raw")]


TRAILER_WORD = (SOURCES / "data/problems/drum-300-mu-0.4-flow.h5").read_bytes()[-12:-4]


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("ending, names, count", [(".csv", ["csv"], 600), (".json", ["json"], 600), (".toml", ["law", "scene"], 600)])
def test_texts_are_read_or_refused(ending, names, count, tmp_path):
    texts, path = corpus(*names), tmp_path / ("f" + ending)
    if ending == ".json":
        texts = [text.partition("\n")[2] for text in texts]  # the first line is the name of the file
    read = 0
    for text in mutations(texts, count, 20240607):
        path.write_bytes(text.encode("utf-8", "surrogateescape"))
        read += read_or_refused(path)
    assert len(texts) // 2 < read < count + len(texts)


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("name", ["snapshot", "checkpoint", "contact_problem"])
def test_contents_of_hdf5_are_read_or_refused(name, tmp_path):
    texts, path = corpus(name), tmp_path / "f.h5"
    read = 0
    for text in mutations(texts, 120, 20240607):
        write_described(path, text)
        read += read_or_refused(path)
    assert read >= len(texts)


def test_bytes_are_refused_by_the_checksum(tmp_path):
    path, draw = tmp_path / "f.h5", random.Random(7)
    write_described(path, corpus("snapshot")[0])
    whole = path.read_bytes()
    assert read_or_refused(path)
    for k in range(200):
        spoilt = bytearray(whole if k % 2 else whole[:draw.randrange(len(whole))])
        if k % 2:
            spoilt[draw.randrange(len(spoilt) - 12)] ^= 1 << draw.randrange(8)
        path.write_bytes(spoilt)
        assert not read_or_refused(path)


@pytest.mark.parametrize("line", ["W/i int 0 1 100000000 3 0 3", "W/i int 0 1 -1 3 0 3", "W/p int 0 2147483647 3 4 6", "W/p int 0 -5 3 4 6",
                                  "W/p int 0 5 1 4 6", "W/p int 0", "W/i int 0", "W/x double 1", "W/nz int 5", "W/nz int -3", "W/m int 1000000",
                                  "W/nz int -1\nfclib_local/W/i int 0 1 7 3 0 3"])
def test_problems_with_wrong_indices_are_refused_as_the_command_refuses_them(line, tmp_path):
    path, name = tmp_path / "p.h5", "fclib_local/" + line.split()[0]
    good = [entry for entry in corpus("contact_problem")[0].splitlines() if entry.strip()]
    write_described(path, "\n".join(good), seal=False)
    assert read_or_refused(path)
    replaced = {entry.split()[0]: entry for entry in [*good, *("fclib_local/" + line).splitlines()]}
    assert name in replaced
    write_described(path, "\n".join(replaced.values()), seal=False)
    with pytest.raises(drumlin.InputError) as refused:
        drumlin.read(path)
    with pytest.raises(drumlin.InputError) as by_command:
        drumlin.command("solve-contacts", path)
    assert str(refused.value) == str(by_command.value)


def test_hdf5_that_leads_elsewhere_or_says_more_than_it_holds_is_refused(tmp_path):
    secret = tmp_path / "secret.h5"
    with h5py.File(secret, "w") as file:
        file["x"] = np.arange(3.0)
    text = corpus("snapshot")[0]

    def virtual(file, name):
        layout = h5py.VirtualLayout((3,), float)
        layout[:] = h5py.VirtualSource(secret, "x", (3,))
        file.create_virtual_dataset(name, layout)

    def spoil(file, name, how):
        del file[name]
        how(file, name)

    for how in (lambda file, name: file.__setitem__(name, h5py.ExternalLink(secret, "x")),
                lambda file, name: file.__setitem__(name, h5py.SoftLink("/grains/z")), virtual,
                lambda file, name: file.create_dataset(name, (2**27,), float, external=[(str(secret), 0, 8 * 2**27)]),
                lambda file, name: file.create_dataset(name, (2**40,), float, chunks=(1024,)),
                lambda file, name: file.create_dataset(name, (2**20,), "S4000", chunks=(16,)),
                lambda file, name: file.create_dataset(name, data=["a", "b"], dtype=h5py.string_dtype()),
                lambda file, name: file.create_dataset(name, data=np.zeros(2, [("a", float), ("b", int)])),
                lambda file, name: file.create_dataset(name, (2,), h5py.ref_dtype)):
        path = tmp_path / "f.h5"
        write_described(path, text, seal=False)
        with h5py.File(path, "a") as file:
            spoil(file, "grains/x", how)
        sealed(path)
        with pytest.raises(drumlin.InputError, match="grains/x"), warnings.catch_warnings():
            drumlin.read(path)
