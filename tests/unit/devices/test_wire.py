"""Frames against bytes of all kinds, and numbers against answers of all ages."""

import binascii
import itertools

from hypothesis import given
from hypothesis import strategies as st

from benchlab.devices.wire import ANSWER, HEAD, MOST_PAYLOAD, NUMBERS, SYNC, Decoder, Frame, Wire, encode

frames = st.builds(Frame, st.integers(0, NUMBERS - 1), st.integers(0, 255), st.binary(max_size=MOST_PAYLOAD))
MOST = HEAD.size + MOST_PAYLOAD + 2


def in_pieces(data: bytes, cuts: list[int]) -> list[bytes]:
    edges = sorted({0, len(data), *(cut % (len(data) + 1) for cut in cuts)})
    return [data[a:b] for a, b in itertools.pairwise(edges)]


def test_the_crc_is_the_catalogues() -> None:
    """CRC-16/IBM-3740 of "123456789" is 0x29B1 (catalogue of parametrised CRC algorithms)."""
    assert binascii.crc_hqx(b"123456789", 0xFFFF) == 0x29B1
    body = encode(Frame(0x3231, 0x33, b"456789"))
    assert body[-2:] == binascii.crc_hqx(body[1:-2], 0xFFFF).to_bytes(2, "little")
    assert body[:5] == bytes([SYNC, 6, 0x31, 0x32, 0x33])


@given(st.lists(frames, max_size=8), st.lists(st.integers(0, 400)))
def test_what_is_sent_is_heard_in_whatever_pieces(sent: list[Frame], cuts: list[int]) -> None:
    decoder = Decoder()
    heard = [f for piece in in_pieces(b"".join(map(encode, sent)), cuts) for f in decoder.feed(piece)]
    assert heard == sent
    assert decoder.crc_errors == decoder.garbage == 0


@given(st.binary(max_size=2000), st.lists(st.integers(0, 2000)))
def test_any_bytes_in_any_pieces_are_the_same_and_kept_short(data: bytes, cuts: list[int]) -> None:
    whole, cut = Decoder(), Decoder()
    heard = whole.feed(data)
    again = []
    for piece in in_pieces(data, cuts):
        again += cut.feed(piece)
        assert len(cut._left) < MOST
    assert again == heard
    assert (cut.crc_errors, cut.garbage) == (whole.crc_errors, whole.garbage)


@given(st.binary(max_size=200), st.lists(frames, min_size=1, max_size=3))
def test_after_noise_it_finds_the_frames_again(noise: bytes, sent: list[Frame]) -> None:
    """All frames that come after a pause long enough for the longest that the noise may have begun."""
    decoder = Decoder()
    decoder.feed(noise)
    decoder.feed(bytes(MOST))
    assert decoder.feed(b"".join(map(encode, sent))) == sent


@given(st.binary(max_size=300).map(lambda b: b.replace(bytes([SYNC]), b"")), st.lists(frames, min_size=1, max_size=3))
def test_every_byte_that_is_no_frame_is_counted(noise: bytes, sent: list[Frame]) -> None:
    decoder = Decoder()
    assert decoder.feed(noise + b"".join(map(encode, sent))) == sent
    assert decoder.garbage == len(noise)


@given(frames, st.data())
def test_a_flipped_bit_is_never_heard(frame: Frame, data: st.DataObject) -> None:
    sent = bytearray(encode(frame))
    at = data.draw(st.integers(0, 8 * len(sent) - 1))
    sent[at // 8] ^= 1 << at % 8
    decoder = Decoder()
    assert frame not in decoder.feed(bytes(sent) + bytes(MOST))
    assert decoder.garbage >= len(sent)


def answer(number: int, command: int) -> bytes:
    return encode(Frame(number, command | ANSWER, b"x"))


def test_only_the_answer_to_the_last_command_is_one() -> None:
    wire = Wire()
    wire.ask(3)
    assert wire.hear(answer(1, 3)) == b"x"
    assert wire.hear(answer(1, 3)) is None and wire.old == 1  # twice
    wire.ask(3)
    assert wire.hear(answer(1, 3)) is None and wire.old == 2  # late
    assert wire.hear(answer(2, 4)) is None and wire.old == 3  # to another command
    assert wire.hear(answer(1, 3) + answer(2, 3)) == b"x" and wire.old == 4


def test_numbers_begin_again() -> None:
    wire = Wire(first=NUMBERS - 1)
    wire.ask(3)
    assert wire.number == NUMBERS - 1
    wire.ask(3)
    assert wire.number == 0
    assert wire.hear(answer(0, 3)) == b"x"
