#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <map>
#include <sstream>
#include <utility>

#include "base/files.h"
#include "document/node.h"
#include "document/syntax.h"

namespace softgrip::document {

namespace {

/// Thrown by an event handler when the document exceeds a limit; the exception ends the parser. This also
/// limits the recursion of the parser, because the parser reports each level before it descends to the next
/// level.
struct Abandoned {};

Location location_of(const YAML::Mark& mark) {
  return {mark.line + 1, mark.column + 1};
}

/// Builds the tree of nodes from the events of the parser. An alias is a single event; its node is not
/// copied.
class TreeBuilder final : public YAML::EventHandler {
 public:
  TreeBuilder(Document& document, Problems& problems, const Bounds& bounds)
      : document_(document), problems_(problems), bounds_(bounds) {}

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (started_) {
      refuse(location_of(mark), "a second document starts here",
             "a file may contain only one document: remove `---`");
      throw Abandoned{};
    }
    started_ = true;
  }
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    Node node;
    node.at = begin(mark, "", anchor);
    const bool is_key =
        !frames_.empty() && frames_.back().node.kind == Node::Kind::map && !frames_.back().has_key;
    if (anchor == 0 && !is_key) node.at = empty_value_at(mark);
    place(std::move(node));
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t /*anchor*/) override {
    const Location at = begin(mark, "", 0);
    refuse(at, "an alias (`*name`) is not accepted here", "write the value itself instead of the alias");
    Node node;
    node.at = at;
    node.refused = true;
    place(std::move(node));
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    Node node;
    node.kind = Node::Kind::scalar;
    node.at = begin(mark, tag, anchor);
    node.scalar = value;
    node.quoted = tag == "!";
    if (!is_closed(mark)) {
      refuse(node.at, "the quotation mark that opens here is never closed", "");
      throw Abandoned{};
    }
    place(std::move(node));
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value style) override {
    open(Node::Kind::sequence, begin(mark, tag, anchor));
    frames_.back().flow = style == YAML::EmitterStyle::Flow;
  }
  void OnSequenceEnd() override { close(); }

  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value /*style*/) override {
    open(Node::Kind::map, begin(mark, tag, anchor));
  }
  void OnMapEnd() override { close(); }

  /// Returns the innermost map or sequence that is still open, or nullptr.
  [[nodiscard]] const Node* open_node() const { return frames_.empty() ? nullptr : &frames_.back().node; }

  /// Moves the incomplete nodes of the stack into the tree. Called when the parser has stopped before the end
  /// of the text.
  void fold() {
    while (!frames_.empty()) {
      const Frame* parent = frames_.size() > 1 ? &frames_[frames_.size() - 2] : nullptr;
      const bool is_key = parent != nullptr && parent->node.kind == Node::Kind::map && !parent->has_key;
      if (is_key) {
        frames_.pop_back();
      } else {
        // If the parser stopped early, a list such as `[1, 2` may lack items, so this list is refused. A list
        // in block style contains complete items and is accepted.
        frames_.back().node.refused = frames_.back().flow;
        close();
      }
    }
  }

  /// Marks the value before an invalid key as refused, because the parser may have read the words of this key
  /// as a part of the value.
  void distrust_last_value() {
    if (frames_.empty() || frames_.back().node.entries.empty()) return;
    frames_.back().node.entries.back().value.refused = true;
  }

  [[nodiscard]] Location last_at() const { return last_at_; }

 private:
  struct Frame {
    Node node;
    bool flow = false;       // for a sequence: true if it is written as `[...]`
    bool has_key = false;    // for a map: the key was read; its value is the next event
    bool key_wanted = true;  // for a map: true if the key was accepted
    std::string key;
    Location key_at;
    std::map<std::string, std::size_t> index;  // for a map: index of the entry for each key
  };

  void refuse(Location at, std::string message, std::string hint) {
    problems_.add(document_.problem(at, std::move(message), std::move(hint)));
    if (problems_.full()) throw Abandoned{};
  }

  /// Counts a node and refuses its tag and anchor. Every event that begins a node must call this function.
  /// Returns the location of the node.
  Location begin(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor) {
    const Location at = location_of(mark);
    last_at_ = at;
    if (++nodes_ > bounds_.nodes) {
      refuse(at, "the document has more than " + std::to_string(bounds_.nodes) + " values", "");
      throw Abandoned{};
    }
    if (anchor != 0) refuse(at, "an anchor (`&name`) is not accepted here", "remove it");
    // The parser reports the tag "?" for a plain node and "!" for a quoted node. It also reports "!" for a
    // node with a written `!`. To distinguish the last two cases, the text is searched for the `!`.
    const auto position = static_cast<std::size_t>(std::max(mark.pos, 0));
    const bool written = position < document_.text.size() && document_.text[position] == '!';
    if ((!tag.empty() && tag != "?" && tag != "!") || (tag == "!" && written)) {
      refuse(at, "a tag (`!name`) is not accepted here",
             "remove the tag, because the key determines the type");
    }
    return at;
  }

  /// Returns false if a quoted text starts at `mark` and is not closed before the end of the file. The parser
  /// accepts an unclosed text that contains a line break, so this function must detect it.
  [[nodiscard]] bool is_closed(const YAML::Mark& mark) const {
    const std::string& text = document_.text;
    auto position = static_cast<std::size_t>(std::max(mark.pos, 0));
    if (position >= text.size() || (text[position] != '"' && text[position] != '\'')) return true;
    const char quote = text[position];
    for (++position; position < text.size(); ++position) {
      if (quote == '"' && text[position] == '\\') {
        ++position;
      } else if (text[position] == quote) {
        if (quote == '"' || position + 1 >= text.size() || text[position + 1] != quote) return true;
        ++position;
      }
    }
    return false;
  }

  /// Returns the location of a missing value, which is the end of the text before this value. The parser
  /// reports the location of the next token, which may be several lines below.
  [[nodiscard]] Location empty_value_at(const YAML::Mark& mark) const {
    const std::string& text = document_.text;
    auto position = std::min(static_cast<std::size_t>(std::max(mark.pos, 0)), text.size());
    if (position < text.size() && (text[position] == '~' || text[position] == 'n' || text[position] == 'N')) {
      return location_of(mark);
    }
    const std::size_t last = text.find_last_not_of(" \t\r\n", position == 0 ? 0 : position - 1);
    if (position == 0 || last == std::string::npos) return {1, 1};
    const auto end = text.begin() + static_cast<std::ptrdiff_t>(last);
    const auto breaks = std::count(text.begin(), end, '\n');
    const std::size_t line_begin = breaks == 0 ? 0 : text.rfind('\n', last) + 1;
    return {static_cast<int>(breaks) + 1, static_cast<int>(last - line_begin) + 1};
  }

  void open(Node::Kind kind, Location at) {
    if (frames_.size() >= static_cast<std::size_t>(std::max(bounds_.depth, 0))) {
      refuse(at, "the document is nested deeper than " + std::to_string(bounds_.depth) + " levels", "");
      throw Abandoned{};
    }
    Frame frame;
    frame.node.kind = kind;
    frame.node.at = at;
    frames_.push_back(std::move(frame));
  }

  void close() {
    Node node = std::move(frames_.back().node);
    frames_.pop_back();
    place(std::move(node));
  }

  /// Adds a finished node to the tree: as root, item, key or value.
  void place(Node&& node) {
    if (frames_.empty()) {
      document_.root = std::move(node);
      return;
    }
    Frame& frame = frames_.back();
    if (frame.node.kind == Node::Kind::sequence) {
      frame.node.items.push_back(std::move(node));
    } else if (!frame.has_key) {
      place_key(frame, std::move(node));
    } else {
      frame.has_key = false;
      if (!frame.key_wanted) return;
      frame.index.emplace(frame.key, frame.node.entries.size());
      frame.node.entries.push_back({std::move(frame.key), frame.key_at, std::move(node)});
    }
  }

  void place_key(Frame& frame, Node&& node) {
    frame.has_key = true;
    frame.key_at = node.at;
    frame.key_wanted = accept_key(frame, node);
    frame.key = std::move(node.scalar);
  }

  bool accept_key(const Frame& frame, const Node& node) {
    if (node.refused) return false;
    if (node.kind != Node::Kind::scalar || node.scalar.empty()) {
      refuse(node.at, "a key must be a plain word", "put a key with special characters in quotes");
      return false;
    }
    if (node.scalar == "<<" && !node.quoted) {
      document_.complete = false;
      refuse(node.at, "a merge key (`<<`) is not accepted here", "write the keys of the other map here");
      return false;
    }
    const auto first = frame.index.find(node.scalar);
    if (first == frame.index.end()) return true;
    refuse(node.at,
           "the key `" + shown(node.scalar) + "` already appears at " +
               text_of(frame.node.entries[first->second].key_at),
           "remove one of the two keys");
    return false;
  }

  Document& document_;
  Problems& problems_;
  const Bounds& bounds_;
  std::vector<Frame> frames_;
  std::size_t nodes_ = 0;
  bool started_ = false;
  Location last_at_;
};

/// Returns the location in the exception. If the exception has no location, returns the last location that
/// the parser reached.
Location place_of(const YAML::ParserException& error, const TreeBuilder& builder) {
  return error.mark.is_null() ? builder.last_at() : location_of(error.mark);
}

void parse_into(Document& document, Problems& problems, const Bounds& bounds) {
  TreeBuilder builder(document, problems, bounds);
  document.complete = true;
  try {
    std::istringstream stream(document.text);
    YAML::Parser parser(stream);
    while (parser.HandleNextDocument(builder)) {
    }
    return;
  } catch (const Abandoned&) {
  } catch (const YAML::ParserException& error) {
    const Location at = place_of(error, builder);
    builder.distrust_last_value();
    SyntaxMessage message = syntax_message(document, error.msg, builder.open_node(), at);
    problems.add(document.problem(at, std::move(message.message), std::move(message.hint)));
  } catch (const YAML::Exception& error) {
    problems.add(document.problem(builder.last_at(), "this is not YAML: " + shown(error.msg)));
  }
  document.complete = false;
  builder.fold();
}

}  // namespace

Problem Document::problem(Location at, std::string message, std::string hint) const {
  return {file, at, std::string(line_of(text, at.line)), std::move(message), std::move(hint)};
}

Document parse(std::string file, std::string text, Problems& problems, const Bounds& bounds) {
  Document document;
  document.file = std::move(file);
  document.text = std::move(text);
  document.complete = false;
  if (check_text(document, bounds, problems)) parse_into(document, problems, bounds);
  return document;
}

Document parse_file(const std::string& path, Problems& problems, const Bounds& bounds) {
  Document document;
  document.file = path;
  document.complete = false;
  const auto file = open_regular(path);
  // One byte more than the permitted size is read. If the file is too large, check_text() detects this from
  // the additional byte, so the rest of the file need not be read.
  auto text = file ? read_start(*file, bounds.bytes + 1) : tl::unexpected(file.error());
  if (!text) {
    problems.add({path, {}, {}, "the file cannot be read: " + text.error(), {}});
    return document;
  }
  return parse(path, std::move(*text), problems, bounds);
}

}  // namespace softgrip::document
