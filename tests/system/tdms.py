"""Writes .tdms files of LabVIEW for tests, by the description of the format (TDMS File Format Internal Structure)."""

import struct

CODES = {"f64": (10, "<d"), "f32": (9, "<f"), "i16": (2, "<h"), "i32": (3, "<i"), "time": (0x44, None), "text": (0x20, None)}


class Channel:
    def __init__(self, values, properties=None, kind="f64"):
        self.values, self.properties, self.kind = values, properties or {}, kind

    def encoded(self, values):
        if self.kind == "time":
            return [struct.pack("<Qq", int((value % 1) * 2**64), int(value)) for value in values]
        if self.kind == "text":
            texts = [value.encode() for value in values]
            ends = [sum(map(len, texts[:i + 1])) for i in range(len(texts))]
            return [struct.pack(f"<{len(ends)}I", *ends) + b"".join(texts)]
        return [struct.pack(CODES[self.kind][1], value) for value in values]


def text(value):
    return struct.pack("<I", len(value.encode())) + value.encode()


def property_bytes(name, value):
    if isinstance(value, str):
        return text(name) + struct.pack("<I", 0x20) + text(value)
    if name == "wf_start_time":
        return text(name) + struct.pack("<IQq", 0x44, int((value % 1) * 2**64), int(value))
    return text(name) + struct.pack("<Id", 10, value)


def segment(group, channels, pieces=1, interleaved=False, rows=None, repeat=False):
    """Returns a segment with the given rows. `repeat` is True if the metadata of the previous segment remains
    valid."""
    begin, end = rows or (0, max(len(channel.values) for channel in channels.values()))
    metadata = struct.pack("<I", len(channels))
    for name, channel in channels.items():
        values = channel.values[begin:end]
        metadata += text(f"/'{group}'/'{name}'")
        index = struct.pack("<IIQ", CODES[channel.kind][0], 1, len(values) // pieces)
        if channel.kind == "text":
            index += struct.pack("<Q", sum(map(len, channel.encoded(values))))
        metadata += struct.pack("<I", len(index) + 4) + index
        metadata += struct.pack("<I", len(channel.properties))
        metadata += b"".join(property_bytes(*pair) for pair in channel.properties.items())
    raw = b""
    for piece in range(pieces):
        step = (end - begin) // pieces
        columns = [channel.encoded(channel.values[begin + piece * step:begin + (piece + 1) * step]) for channel in channels.values()]
        raw += b"".join(b"".join(row) for row in zip(*columns)) if interleaved else b"".join(map(b"".join, columns))
    flags = 8 | (0 if repeat else 2 | 4) | (32 if interleaved else 0)
    metadata = b"" if repeat else metadata
    return b"TDSm" + struct.pack("<IIQQ", flags, 4713, len(metadata) + len(raw), len(metadata)) + metadata + raw


def in_segments(group, channels, rows):
    count = max(len(channel.values) for channel in channels.values())
    return [segment(group, channels, rows=(begin, begin + rows), repeat=begin > 0) for begin in range(0, count, rows)]


def file(segments):
    return b"".join(segments)
