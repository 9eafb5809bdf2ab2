#include "rig/rig_file_reader.h"

#include <algorithm>

#include "document/node.h"

namespace softgrip::rig {

namespace {

using document::Location;
using document::Node;

/// Returns true if an item of a list is at the location `at`. The list may be at any depth in `node`.
bool has_item_at(const Node& node, Location at) {
  const auto entry_at = [&](const Node::Entry& entry) {
    return entry.key_at == at || entry.value.at == at || has_item_at(entry.value, at);
  };
  const auto item_at = [&](const Node& item) {
    return item.at == at || has_item_at(item, at) ||
           std::any_of(item.entries.begin(), item.entries.end(), entry_at);
  };
  return std::any_of(node.items.begin(), node.items.end(), item_at);
}

/// Marks the node at a location as refused, so that no further problem is reported for this node. If the node
/// is an unknown key, also marks the map that contains the key: the unknown key may be a misspelt required
/// key, which would otherwise be reported as missing. Returns true if the location is in `map`.
bool settle_in(Node& map, Location at) {
  const auto unknown = std::find_if(map.entries.begin(), map.entries.end(),
                                    [&](const Node::Entry& entry) { return entry.key_at == at; });
  if (unknown != map.entries.end()) {
    map.entries.erase(unknown);
    map.refused = true;
    return true;
  }
  for (Node::Entry& entry : map.entries) {
    Node& value = entry.value;
    if (settle_in(value, at)) return true;
    if (value.at != at && !has_item_at(value, at)) continue;
    value.refused = true;
    if (value.kind == Node::Kind::map) value.kind = Node::Kind::null;
    return true;
  }
  return false;
}

}  // namespace

ChannelDefaults::ChannelDefaults(Context& context, MapReader& top) : context_(context) {
  const Node* const node = top.child("channel_defaults", false);
  if (node == nullptr) return;
  shared_ = *node;
  if (node->kind != Node::Kind::map) {
    if (!node->refused && (node->kind != Node::Kind::null || context.document.complete)) {
      top.report("channel_defaults",
                 "`channel_defaults` must be a map of keys, found " + document::found(*node));
    }
    shared_ = {};
    shared_.refused = spoiled_ = true;
    return;
  }
  std::erase_if(shared_.entries, [&](const Node::Entry& entry) {
    const bool name = entry.key == "name";
    if (!name && entry.key != "plausibility" && entry.key != "model_health") return false;
    context.problems.add(context.document.problem(
        entry.key_at,
        name ? "channels cannot share a name"
             : "`" + entry.key + "` for all channels belongs to the top level of the file",
        name ? "give each channel a different name"
             : "move this key out of `channel_defaults` to the top level of the file"));
    spoiled_ = true;
    return true;
  });
}

Node ChannelDefaults::completed(const Node& channel) {
  Node whole = channel;
  if (whole.kind == Node::Kind::map) fill(whole, shared_);
  return whole;
}

void ChannelDefaults::fill(Node& own, const Node& shared) {
  own.refused = own.refused || shared.refused;
  for (const Node::Entry& entry : shared.entries) {
    const auto found = std::find_if(own.entries.begin(), own.entries.end(),
                                    [&](const Node::Entry& other) { return other.key == entry.key; });
    if (found == own.entries.end()) {
      own.entries.push_back(entry);
    } else if (found->value.kind == Node::Kind::map && entry.value.kind == Node::Kind::map) {
      fill(found->value, entry.value);
    } else if (found->value.kind == Node::Kind::map && !entry.value.refused) {
      context_.problems.add(context_.document.problem(
          entry.value.at, "`" + entry.key + "` of `channel_defaults` must be a map, as it is in a channel"));
    }
  }
}

void ChannelDefaults::settle(std::size_t before) {
  const auto& problems = context_.problems.list();
  for (std::size_t i = before; i < problems.size(); ++i) {
    if (problems[i].file == context_.document.file && settle_in(shared_, problems[i].at)) spoiled_ = true;
  }
}

}  // namespace softgrip::rig
