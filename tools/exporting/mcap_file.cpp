#include "tools/exporting/signals.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string_view>

#include "base/json.h"
#include "base/numbers.h"
#include "base/time.h"
#include "sysid/import/mcap_table.h"

namespace softgrip::tools {
namespace {

using Opcode = sysid::McapOpcode;

constexpr std::size_t chunk_bytes = std::size_t{4} << 20U;
constexpr std::uint16_t first_id = 1;

template <class T>
void put(std::string& bytes, T value) {
  for (std::size_t i = 0; i < sizeof(T); ++i)
    bytes += static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * i) & 0xffU);
}

void put_text(std::string& bytes, std::string_view text) {
  put(bytes, static_cast<std::uint32_t>(text.size()));
  bytes += text;
}

std::string record(Opcode opcode, std::string_view content) {
  std::string bytes;
  put(bytes, static_cast<std::uint8_t>(opcode));
  put(bytes, static_cast<std::uint64_t>(content.size()));
  return bytes.append(content);
}

std::uint32_t checksum(std::string_view bytes) {
  return static_cast<std::uint32_t>(
      ::crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<z_size_t>(bytes.size())));
}

std::string json_text(const std::string& text) {
  return json_dump(nlohmann::json(text));
}

/// One sample of a group. The samples of all groups are sorted by time.
struct Sample {
  std::uint64_t time_ns = 0;
  std::size_t group = 0;
  std::size_t row = 0;
};

std::vector<Sample> samples_of(const std::vector<SignalGroup>& groups) {
  std::vector<Sample> samples;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    for (std::size_t i = 0; i < groups[g].time_s.size(); ++i) {
      const Nanoseconds time = nanoseconds(std::max(0.0, groups[g].time_s[i]));
      samples.push_back({static_cast<std::uint64_t>(time), g, i});
    }
  }
  std::stable_sort(samples.begin(), samples.end(),
                   [](const Sample& a, const Sample& b) { return a.time_ns < b.time_ns; });
  return samples;
}

std::string json_of(const SignalGroup& group, std::size_t row, const std::vector<std::string>& keys) {
  std::string json = "{\"time_s\":" + shortest(group.time_s[row]);
  for (std::size_t k = 0; k < group.signals.size(); ++k) {
    const Signal& signal = group.signals[k];
    if (signal.is_text()) {
      json += "," + keys[k] + ":" + json_text(signal.texts[row]);
    } else if (std::isfinite(signal.values[row])) {
      json += "," + keys[k] + ":" + shortest(signal.values[row]);
    }
  }
  return json + "}";
}

std::string schema_of(const SignalGroup& group) {
  nlohmann::ordered_json properties{{"time_s", {{"type", "number"}}}};
  for (const Signal& signal : group.signals)
    properties[signal.name] = {{"type", signal.is_text() ? "string" : "number"}};
  return json_dump(nlohmann::ordered_json{{"type", "object"}, {"properties", properties}});
}

class Writer {
 public:
  explicit Writer(const std::vector<SignalGroup>& groups) : groups_(groups) {
    for (const SignalGroup& group : groups) {
      std::vector<std::string>& keys = keys_.emplace_back();
      for (const Signal& signal : group.signals) keys.push_back(json_text(signal.name));
    }
  }

  std::string run(const std::string& library) {
    bytes_ = sysid::mcap_magic;
    std::string header;
    put_text(header, "");
    put_text(header, library);
    bytes_ += record(Opcode::header, header);
    for (const Sample& sample : samples_of(groups_)) {
      add(sample);
      if (chunk_.size() > chunk_bytes) end_chunk();
    }
    end_chunk();
    std::string end;
    put(end, checksum(bytes_));
    bytes_ += record(Opcode::data_end, end);
    add_summary();
    return std::move(bytes_) + std::string(sysid::mcap_magic);
  }

 private:
  [[nodiscard]] static std::uint16_t id_of(std::size_t group) {
    return static_cast<std::uint16_t>(group + first_id);
  }

  [[nodiscard]] std::string schema_record(std::size_t g) const {
    const std::string& name = groups_[g].name;
    std::string content;
    put(content, id_of(g));
    put_text(content, "softgrip." + (name.empty() ? std::string("signals") : name));
    put_text(content, "jsonschema");
    put_text(content, schema_of(groups_[g]));
    return record(Opcode::schema, content);
  }
  [[nodiscard]] std::string channel_record(std::size_t g) const {
    const std::string& name = groups_[g].name;
    std::string content;
    put(content, id_of(g));
    put(content, id_of(g));
    put_text(content, "/" + (name.empty() ? std::string("signals") : name));
    put_text(content, "json");
    put(content, std::uint32_t{0});
    return record(Opcode::channel, content);
  }

  void add(const Sample& sample) {
    if (chunk_.empty()) {
      // Repeat the schemas in every chunk, so that a reader can read each chunk alone.
      for (std::size_t g = 0; g < groups_.size(); ++g) chunk_ += schema_record(g) + channel_record(g);
      begin_ns_ = sample.time_ns;
    }
    end_ns_ = sample.time_ns;
    index_[sample.group].emplace_back(sample.time_ns, chunk_.size());
    std::string content;
    put(content, id_of(sample.group));
    put(content, static_cast<std::uint32_t>(sample.row));
    put(content, sample.time_ns);
    put(content, sample.time_ns);
    content += json_of(groups_[sample.group], sample.row, keys_[sample.group]);
    chunk_ += record(Opcode::message, content);
  }

  void end_chunk() {
    if (chunk_.empty()) return;
    const std::uint64_t start = bytes_.size();
    std::string content;
    put(content, begin_ns_);
    put(content, end_ns_);
    put(content, static_cast<std::uint64_t>(chunk_.size()));
    put(content, checksum(chunk_));
    put_text(content, "");
    put(content, static_cast<std::uint64_t>(chunk_.size()));
    bytes_ += record(Opcode::chunk, content + chunk_);
    const std::uint64_t length = bytes_.size() - start;
    std::string offsets;
    for (const auto& [group, entries] : index_) {
      put(offsets, id_of(group));
      put(offsets, static_cast<std::uint64_t>(bytes_.size()));
      std::string messages;
      put(messages, id_of(group));
      put(messages, static_cast<std::uint32_t>(entries.size() * 2 * sizeof(std::uint64_t)));
      for (const auto& [time_ns, offset] : entries) {
        put(messages, time_ns);
        put(messages, static_cast<std::uint64_t>(offset));
      }
      bytes_ += record(Opcode::message_index, messages);
      counts_[group] += entries.size();
    }
    std::string index;
    put(index, begin_ns_);
    put(index, end_ns_);
    put(index, start);
    put(index, length);
    put_text(index, offsets);
    put(index, static_cast<std::uint64_t>(bytes_.size()) - start - length);
    put_text(index, "");
    put(index, static_cast<std::uint64_t>(chunk_.size()));
    put(index, static_cast<std::uint64_t>(chunk_.size()));
    chunk_indexes_ += record(Opcode::chunk_index, index);
    if (chunks_++ == 0) first_ns_ = begin_ns_;
    index_.clear();
    chunk_.clear();
  }

  [[nodiscard]] std::string statistics() const {
    std::string content;
    std::uint64_t messages = 0;
    std::string counts;
    for (const auto& [group, count] : counts_) {
      put(counts, id_of(group));
      put(counts, count);
      messages += count;
    }
    put(content, messages);
    put(content, static_cast<std::uint16_t>(groups_.size()));
    put(content, static_cast<std::uint32_t>(groups_.size()));
    put(content, std::uint32_t{0});  // number of attachments in the file
    put(content, std::uint32_t{0});  // number of metadata records in the file
    put(content, chunks_);
    put(content, first_ns_);
    put(content, end_ns_);
    put_text(content, counts);
    return record(Opcode::statistics, content);
  }

  void add_summary() {
    const std::uint64_t start = bytes_.size();
    std::string schemas;
    std::string channels;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      schemas += schema_record(g);
      channels += channel_record(g);
    }
    std::string offsets;
    const auto add_group = [&](Opcode opcode, const std::string& records) {
      if (records.empty()) return;
      std::string content;
      put(content, static_cast<std::uint8_t>(opcode));
      put(content, static_cast<std::uint64_t>(bytes_.size()));
      put(content, static_cast<std::uint64_t>(records.size()));
      offsets += record(Opcode::summary_offset, content);
      bytes_ += records;
    };
    add_group(Opcode::schema, schemas);
    add_group(Opcode::channel, channels);
    add_group(Opcode::statistics, statistics());
    add_group(Opcode::chunk_index, chunk_indexes_);
    const std::uint64_t offsets_start = bytes_.size();
    bytes_ += offsets;
    std::string footer;
    put(footer, start);
    put(footer, offsets_start);
    put(footer, std::uint32_t{0});
    footer = record(Opcode::footer, footer);
    // The checksum covers all bytes of the footer before the checksum.
    footer.resize(footer.size() - sizeof(std::uint32_t));
    bytes_ += footer;
    put(bytes_, checksum(std::string_view(bytes_).substr(start)));
  }

  const std::vector<SignalGroup>& groups_;
  std::vector<std::vector<std::string>> keys_;
  std::string bytes_;
  std::string chunk_;
  std::string chunk_indexes_;
  std::map<std::size_t, std::vector<std::pair<std::uint64_t, std::size_t>>> index_;
  std::map<std::size_t, std::uint64_t> counts_;
  std::uint64_t first_ns_ = 0, begin_ns_ = 0, end_ns_ = 0;
  std::uint32_t chunks_ = 0;
};

}  // namespace

std::string mcap_bytes(const std::vector<SignalGroup>& groups, const std::string& library) {
  return Writer(groups).run(library);
}

}  // namespace softgrip::tools
