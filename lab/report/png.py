"""Reads and writes pictures of 8 bits per channel as PNG."""

import struct
import zlib

SIGNATURE = b"\x89PNG\r\n\x1a\n"
CHANNELS = {0: 1, 2: 3, 4: 2, 6: 4}  # by colour type


def _paeth(left, up, corner):
    to_left, to_up, to_corner = abs(up - corner), abs(left - corner), abs(left + up - 2 * corner)
    return left if to_left <= to_up and to_left <= to_corner else up if to_up <= to_corner else corner


def _undo_filter(kind, row, before, step):
    for i in range(len(row)) if kind else ():
        left, up, corner = row[i - step] if i >= step else 0, before[i], before[i - step] if i >= step else 0
        row[i] = row[i] + (left, up, left + up >> 1, _paeth(left, up, corner))[kind - 1] & 255
    return row


def read_first_channel(path):
    """Returns a row of the first channel's bytes for each line of a picture without interlacing. Raises ValueError."""
    with open(path, "rb") as file:
        data = file.read()
    chunks, at = {}, len(SIGNATURE)
    while at < len(data):
        length, name = struct.unpack_from(">I4s", data, at)
        chunks[name] = chunks.get(name, b"") + data[at + 8:at + 8 + length]
        at += length + 12
    width, height, depth, color, _, _, interlace = struct.unpack(">IIBBBBB", chunks[b"IHDR"])
    if not data.startswith(SIGNATURE) or depth != 8 or color not in CHANNELS or interlace:
        raise ValueError(f"{path}: is not a plain PNG of 8 bits")
    step = CHANNELS[color]
    lines, size = zlib.decompress(chunks[b"IDAT"]), 1 + width * step
    rows, row = [], bytearray(width * step)
    for y in range(height):
        row = _undo_filter(lines[y * size], bytearray(lines[y * size + 1:(y + 1) * size]), row, step)
        rows.append(bytes(row[::step]))
    return rows


def write_grey(path, rows):
    def chunk(name, content):
        return struct.pack(">I", len(content)) + name + content + struct.pack(">I", zlib.crc32(name + content))
    header = struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 0, 0, 0, 0)
    with open(path, "wb") as file:
        file.write(SIGNATURE + chunk(b"IHDR", header) +
                   chunk(b"IDAT", zlib.compress(b"".join(b"\0" + bytes(row) for row in rows))) + chunk(b"IEND", b""))
