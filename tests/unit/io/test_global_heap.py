"""Global heaps: sound ones pass, and those on which the HDF5 library would not come back are told apart."""

import h5py
import pytest

from benchlab.io.global_heap import global_heaps_are_sound


@pytest.fixture
def texts(tmp_path):
    path = tmp_path / "texts.h5"
    with h5py.File(path, "w") as file:
        file["a"] = ["one", "two", "θ" * 500]
        file["b"] = ["x" * 5000] * 4
    return path


def objects(data):
    """Offsets of the objects in the first heap, the free space last."""
    start = data.index(b"GCOL")
    at, end = start + 16, start + int.from_bytes(data[start + 8 : start + 16], "little")
    while at + 16 <= end:
        yield at
        if data[at : at + 2] == b"\0\0":
            return
        at += 16 + (int.from_bytes(data[at + 8 : at + 16], "little") + 7) // 8 * 8


def test_files_as_they_are_written_are_sound(texts, tmp_path):
    assert texts.read_bytes().count(b"GCOL") > 1
    assert global_heaps_are_sound(texts)
    with h5py.File(tmp_path / "none.h5", "w") as file:
        file["a"] = [1.0]
    assert global_heaps_are_sound(tmp_path / "none.h5")


def test_files_of_which_texts_were_removed_are_sound(texts):
    with h5py.File(texts, "r+") as file:
        file["a"][1] = "a longer one than there was"
        file["a"][2] = ""
        del file["b"]
    assert global_heaps_are_sound(texts)


def test_free_space_without_a_size_is_not_sound(texts):
    data = bytearray(texts.read_bytes())
    *_, free = objects(data)
    data[free + 8 : free + 16] = bytes(8)
    texts.write_bytes(data)
    assert not global_heaps_are_sound(texts)


def test_any_flipped_bit_in_the_size_of_the_free_space_shows(texts):
    data = texts.read_bytes()
    *_, free = objects(data)
    assert data[free : free + 2] == b"\0\0"
    for bit in range(64):
        flipped = bytearray(data)
        flipped[free + 8 + bit // 8] ^= 1 << (bit % 8)
        texts.write_bytes(flipped)
        assert not global_heaps_are_sound(texts), bit


def test_a_collection_that_leaves_the_file_is_not_sound(texts):
    data = bytearray(texts.read_bytes())
    start = data.index(b"GCOL")
    for size in (0, 8, len(data), 1 << 63):
        data[start + 8 : start + 16] = size.to_bytes(8, "little")
        texts.write_bytes(data)
        assert not global_heaps_are_sound(texts)
