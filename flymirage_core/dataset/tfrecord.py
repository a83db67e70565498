"""TFRecord files of `tf.train.Example` messages, without TensorFlow: the framing, the checksum, the few message fields.

Framing: length (uint64, little endian), masked CRC-32C of it, the message, masked CRC-32C of that. Message: protocol
buffers' wire format of Example { Features { map<string, Feature> } }, Feature = bytes_list | float_list | int64_list.
"""

import struct
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

import numba
import numpy as np
from numpy.typing import NDArray

from flymirage_core.errors import ProductError

Values = list[bytes] | NDArray[np.float32] | NDArray[np.int64]

CASTAGNOLI = 0x82F63B78
"""CRC-32C's polynomial, its bits reversed."""
MASK_DELTA = 0xA282EAD8
LENGTH_DELIMITED = 2
"""Wire type of messages, strings and packed lists."""


def example_bytes(features: Mapping[str, Values]) -> bytes:
    """One serialised Example; keys in sorted order, so that the same features give the same bytes."""
    entries = [_field(1, _field(1, name.encode()) + _field(2, _feature(features[name]))) for name in sorted(features)]
    return _field(1, b"".join(entries))


def write_records(path: Path, messages: Iterable[bytes]) -> int:
    """Write a TFRecord file; returns how many messages there were."""
    path.parent.mkdir(parents=True, exist_ok=True)
    count = 0
    with path.open("wb") as file:
        for message in messages:
            length = struct.pack("<Q", len(message))
            file.write(length + struct.pack("<I", _masked_crc(length)))
            file.write(message)
            file.write(struct.pack("<I", _masked_crc(message)))
            count += 1
    return count


def read_records(path: Path) -> Iterator[bytes]:
    """The messages of a TFRecord file; raises `ProductError` naming the record that is torn or damaged."""
    with path.open("rb") as file:
        number = 0
        while head := file.read(12):
            length, length_crc = struct.unpack("<QI", head) if len(head) == 12 else (0, None)
            if length_crc != _masked_crc(head[:8]):
                raise ProductError(f"{path}: record {number} has a torn head; export again")
            message, tail = file.read(length), file.read(4)
            if len(tail) < 4 or struct.unpack("<I", tail)[0] != _masked_crc(message):
                raise ProductError(f"{path}: record {number} is torn or damaged; export again")
            yield message
            number += 1


def example_from(message: bytes) -> dict[str, Values]:
    """The inverse of `example_bytes`."""
    features: dict[str, Values] = {}
    for _, body in _fields(message):
        for _, entry in _fields(body):
            (_, name), (_, feature) = _fields(entry)
            features[name.decode()] = _values(feature)
    return features


def _feature(values: Values) -> bytes:
    if isinstance(values, list):
        return _field(1, b"".join(_field(1, value) for value in values))
    if values.dtype == np.float32:
        return _field(2, _field(1, values.astype("<f4").tobytes()))
    return _field(3, _field(1, b"".join(_varint(int(v) & (2**64 - 1)) for v in values.ravel())))


def _values(feature: bytes) -> Values:
    ((kind, body),) = _fields(feature)
    fields = [value for _, value in _fields(body)]
    if kind == 1:
        return fields
    packed = b"".join(fields)
    return np.frombuffer(packed, "<f4") if kind == 2 else np.array(list(_varints(packed)), np.uint64).astype(np.int64)


def _field(number: int, payload: bytes) -> bytes:
    return _varint(number << 3 | LENGTH_DELIMITED) + _varint(len(payload)) + payload


def _fields(message: bytes) -> Iterator[tuple[int, bytes]]:
    at = 0
    while at < len(message):
        tag, at = _read_varint(message, at)
        length, at = _read_varint(message, at)
        yield tag >> 3, message[at : at + length]
        at += length


def _varint(value: int) -> bytes:
    digits = bytearray()
    while value > 0x7F:
        digits.append(value & 0x7F | 0x80)
        value >>= 7
    digits.append(value)
    return bytes(digits)


def _varints(packed: bytes) -> Iterator[int]:
    at = 0
    while at < len(packed):
        value, at = _read_varint(packed, at)
        yield value


def _read_varint(message: bytes, at: int) -> tuple[int, int]:
    value = shift = 0
    while True:
        byte = message[at]
        value |= (byte & 0x7F) << shift
        at, shift = at + 1, shift + 7
        if byte < 0x80:
            return value, at


def _masked_crc(data: bytes) -> int:
    crc = int(_crc32c(np.frombuffer(data, np.uint8), _TABLE))
    return ((crc >> 15 | crc << 17) + MASK_DELTA) & 0xFFFFFFFF


def _table() -> NDArray[np.uint32]:
    """(256,): the remainder that each byte leaves."""
    remainders = np.arange(256, dtype=np.uint32)
    for _ in range(8):
        half = remainders >> np.uint32(1)
        remainders = np.where(remainders & 1, half ^ np.uint32(CASTAGNOLI), half)
    return remainders


_TABLE = _table()


@numba.njit(cache=True)
def _crc32c(data: NDArray[np.uint8], table: NDArray[np.uint32]) -> np.uint32:
    crc = np.uint32(0xFFFFFFFF)
    for byte in data:
        crc = table[(crc ^ byte) & np.uint32(0xFF)] ^ (crc >> np.uint32(8))
    return crc ^ np.uint32(0xFFFFFFFF)
