// Prints what @mcap/core reads from an MCAP file: first with its index, then from the beginning with every checksum.
const {McapIndexedReader, McapStreamReader} = require("@mcap/core");

const bytes = require("fs").readFileSync(process.argv[2]);
const readable = {
  size: async () => BigInt(bytes.length),
  read: async (at, length) => bytes.subarray(Number(at), Number(at + length)),
};

(async () => {
  const topics = {};
  const indexed = await McapIndexedReader.Initialize({readable});
  for (const {topic} of indexed.channelsById.values()) {
    topics[topic] = [];
    for await (const message of indexed.readMessages({topics: [topic]}))
      topics[topic].push([Number(message.logTime), JSON.parse(new TextDecoder().decode(message.data))]);
  }
  const stream = new McapStreamReader({validateCrcs: true});
  stream.append(bytes);
  let messages = 0;
  for (let record; (record = stream.nextRecord());) messages += record.type === "Message" ? 1 : 0;
  console.log(JSON.stringify({topics, messages, done: stream.done()}));
})();
