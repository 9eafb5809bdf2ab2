"""Reads MCAP files by the specification (https://mcap.dev/spec) and checks every checksum. It shares no code with the
program that writes the files."""

import json
import struct
import zlib

MAGIC = b"\x89MCAP0\r\n"


class Content:
    """The bytes of one record. Each call reads the next bytes."""

    def __init__(self, data):
        self.data, self.at = data, 0

    def number(self, kind):
        value, = struct.unpack_from("<" + kind, self.data, self.at)
        self.at += struct.calcsize("<" + kind)
        return value

    def bytes(self, kind="I"):
        length = self.number(kind)
        assert self.at + length <= len(self.data), "a text ends after the end of its record"
        self.at += length
        return self.data[self.at - length:self.at]

    def text(self):
        return self.bytes().decode()

    def pairs(self, key, value):
        inside = Content(self.bytes())
        found = []
        while inside.at < len(inside.data):
            found.append((inside.number(key), inside.number(value)))
        return found

    def end(self):
        assert self.at == len(self.data), f"{len(self.data) - self.at} bytes too many"


def records(data, begin, end):
    """Returns (opcode, content, offset) of the records between two offsets in the file."""
    at = begin
    while at < end:
        opcode, length = struct.unpack_from("<BQ", data, at)
        yield opcode, Content(data[at + 9:at + 9 + length]), at
        at += 9 + length
    assert at == end, "the last record ends after the end of its section"


def read(path):
    """Returns {topic: [(log_time_ns, message)]} of a file. Fails if the file deviates from the specification."""
    data = path.read_bytes()
    assert data.startswith(MAGIC) and data.endswith(MAGIC), "no magic"
    footer_at = len(data) - len(MAGIC) - 29
    (opcode, footer, _), = records(data, footer_at, len(data) - len(MAGIC))
    assert opcode == 0x02
    summary_start, offsets_start, crc = footer.number("Q"), footer.number("Q"), footer.number("I")
    footer.end()
    assert crc == zlib.crc32(data[summary_start:footer_at + 25]), "the summary's checksum"
    schemas, channels, messages, chunks, indexes = {}, {}, [], {}, {}
    order = []
    for opcode, content, at in records(data, len(MAGIC), summary_start):
        order.append(opcode)
        if opcode == 0x06:
            chunks[at] = content
            messages += read_chunk(content, schemas, channels)
        elif opcode == 0x07:
            indexes[at] = (content.number("H"), content.pairs("Q", "Q"))
            content.end()
        elif opcode == 0x0F:
            assert content.number("I") == zlib.crc32(data[len(MAGIC) * 0:at]), "the data section's checksum"
    assert order[0] == 0x01 and order[-1] == 0x0F, "header first, data end last"
    check_summary(data, summary_start, offsets_start, footer_at, chunks, indexes, messages, channels)
    topics = {}
    for channel, time_ns, message in messages:
        schema, topic, encoding = channels[channel]
        assert encoding == "json" and schemas[schema][1] == "jsonschema"
        properties = json.loads(schemas[schema][2])["properties"]
        value = json.loads(message)
        assert set(value) <= set(properties), "a key that the schema does not know"
        topics.setdefault(topic, []).append((time_ns, value))
    return topics


def read_chunk(content, schemas, channels):
    first, last, size, crc = content.number("Q"), content.number("Q"), content.number("Q"), content.number("I")
    assert content.text() == "", "packed"
    inside = content.bytes("Q")
    content.end()
    assert size == len(inside) and crc == zlib.crc32(inside), "a chunk's checksum"
    messages = []
    for opcode, record, _ in records(inside, 0, len(inside)):
        if opcode == 0x03:
            number = record.number("H")
            schemas[number] = (record.text(), record.text(), record.bytes())
            record.end()
        elif opcode == 0x04:
            number, schema = record.number("H"), record.number("H")
            assert schema in schemas
            channels[number] = (schema, record.text(), record.text())
        elif opcode == 0x05:
            channel, _, time_ns, _ = (record.number(kind) for kind in "HIQQ")
            assert channel in channels and first <= time_ns <= last
            messages.append((channel, time_ns, record.data[record.at:]))
        else:
            raise AssertionError(f"a record of kind {opcode} in a chunk")
    return messages


def check_summary(data, start, offsets_start, end, chunks, indexes, messages, channels):
    groups, statistics, chunk_indexes = {}, None, 0
    for opcode, content, at in records(data, start, offsets_start):
        first, length = groups.get(opcode, (at, 0))
        groups[opcode] = (first, length + 9 + len(content.data))
        if opcode == 0x0B:
            statistics = [content.number(kind) for kind in "QHIIIIQQ"], dict(content.pairs("H", "Q"))
            content.end()
        elif opcode == 0x08:
            chunk_indexes += 1
            content.number("Q"), content.number("Q")
            chunk_at, length = content.number("Q"), content.number("Q")
            assert chunk_at in chunks and length == 9 + len(chunks[chunk_at].data), \
                "an index does not point to its chunk"
            for channel, index_at in content.pairs("H", "Q"):
                assert indexes[index_at][0] == channel
                records_at = chunk_at + length - len(Content(chunks[chunk_at].data[32:]).bytes("Q"))
                for time_ns, offset in indexes[index_at][1]:
                    opcode_here, _, said, _, time_here, _ = struct.unpack_from("<BQHIQQ", data, records_at + offset)
                    assert (opcode_here, said, time_here) == (0x05, channel, time_ns), \
                        "an index does not point to a message"
    (count, _, channel_count, _, _, chunk_count, first_ns, last_ns), by_channel = statistics
    assert count == len(messages) == sum(by_channel.values()) and channel_count == len(channels)
    assert chunk_count == chunk_indexes == len(chunks)
    assert first_ns == min(m[1] for m in messages) and last_ns == max(m[1] for m in messages)
    told = {}
    for opcode, content, _ in records(data, offsets_start, end):
        assert opcode == 0x0E
        group = content.number("B")
        told[group] = content.number("Q"), content.number("Q")
    assert told == groups, "the summary's offsets"
