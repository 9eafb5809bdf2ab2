#pragma once
// Executes the requests of the socket API. This class does not use sockets itself.

#include <cstdint>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "daemon/socket/client_request.h"
#include "daemon/socket/event_feed.h"
#include "daemon/socket/sequence_loader.h"
#include "daemon/socket/service.h"
#include "daemon/socket/start_ledger.h"
#include "daemon/socket/status_json.h"
#include "rig/daemon_settings.h"

namespace softgrip::daemon {

/// The socket API. All functions must be called from one thread, which must also be the thread that calls
/// Service.
class SocketApi {
 public:
  SocketApi(StatusSources sources, rig::SocketSettings settings, std::shared_ptr<const SequenceLoader> loader,
            const EventLog& events, SendLine send);
  SocketApi(const SocketApi&) = delete;
  SocketApi& operator=(const SocketApi&) = delete;
  /// Cancels the planning that is in progress, but does not wait until it ends, because its thread may be
  /// blocked in the file system.
  ~SocketApi();

  /// Registers a new client with its role. A client that was not registered is read-only.
  void on_opened(ClientId client, Role role);
  /// Processes one line that a client has sent, without its line break.
  void on_line(ClientId client, std::string_view line, Nanoseconds now);
  /// Removes a client that has disconnected.
  void on_closed(ClientId client);
  /// Returns true if the client must keep its connection although it sends no requests. This is the case if
  /// the client has a subscription, or if a start of the client runs or may still begin.
  [[nodiscard]] bool keeps_connection(ClientId client) const;
  /// Returns true while the sequence of a start is being loaded. After the loading, update() passes the
  /// sequence to the loop.
  [[nodiscard]] bool is_loading() const noexcept { return loading_.has_value(); }
  /// Sends the replies of the loop, and the states that are due for the clients of `watch`. Returns the
  /// latest time at which update() must be called again.
  Nanoseconds update(Nanoseconds now);

 private:
  struct Client {
    Role role = Role::look;
    std::string name;  ///< name that the client gave in its hello
  };
  struct PendingRequest {  // a request that was passed to the loop
    ClientId client = 0;
    std::optional<std::uint64_t> id;
    Nanoseconds deadline = 0;
    document::Problems remarks{};                     ///< warnings about the sequence of the request
    std::shared_ptr<const LoadedSequence> checked{};  ///< for a dry run: the sequence that was checked
  };
  struct Watch {
    std::optional<std::uint64_t> id;
    Nanoseconds period = 0;
    Nanoseconds due = 0;
  };

  struct LoadingStart {  // a start whose sequence is being loaded by a separate thread
    ClientId client = 0;
    std::optional<std::uint64_t> id;
    std::future<SequenceLoader::Result> loaded;
    std::stop_source stop;
    std::string start_id;  ///< id that the client gave the start; may be empty
    bool dry_run = false;
    bool abandoned = false;  ///< true: the client that requested the start no longer waits for the result
  };

  struct Listing {  // the list of the sequence directory, which a separate thread reads
    std::future<std::vector<SequenceLoader::SequenceInfo>> read;
    std::vector<std::pair<ClientId, std::optional<std::uint64_t>>> waiting;
  };

  [[nodiscard]] nlohmann::ordered_json refusal_of(ClientId client, const ClientRequest& request) const;
  [[nodiscard]] const std::string* owner() const;
  [[nodiscard]] ClientId owner_client() const;
  [[nodiscard]] nlohmann::ordered_json status() const;
  void process_hello(ClientId client, const ClientRequest& request);
  void start(ClientId client, const ClientRequest& request, Nanoseconds now);
  [[nodiscard]] nlohmann::ordered_json refusal_of_id(const std::string& start_id) const;
  void stop(ClientId client, const ClientRequest& request, Nanoseconds now);
  void stop_of(ClientId client, const ClientRequest& request, Nanoseconds now);
  void start_loaded(const LoadingStart& start, SequenceLoader::Result sequence, Nanoseconds now);
  void process_loaded(Nanoseconds now);
  void abandon_loading() noexcept;
  void refuse_loading();
  std::optional<std::uint32_t> submit(ClientId client, std::optional<std::uint64_t> id,
                                      control::Request::Kind kind,
                                      std::shared_ptr<const LoadedSequence> sequence, Nanoseconds now);
  [[nodiscard]] nlohmann::ordered_json refused_json(control::RefusalCode refusal, const control::Fault& fault,
                                                    std::uint32_t request) const;
  void register_pending(std::optional<std::uint32_t> number, PendingRequest pending);
  void send_reply(const PendingRequest& pending, std::uint32_t request, const Service::Reply& reply);
  void watch(ClientId client, const ClientRequest& request, Nanoseconds now);
  void list_sequences(ClientId client, std::optional<std::uint64_t> id);
  void process_listing();
  void send_result(ClientId client, std::optional<std::uint64_t> id, const nlohmann::ordered_json& result);
  void send_error(ClientId client, std::optional<std::uint64_t> id, const nlohmann::ordered_json& error);

  StatusSources sources_;
  rig::SocketSettings settings_;
  std::string started_at_;
  std::shared_ptr<const SequenceLoader> loader_;
  EventFeed events_;
  SendLine send_;
  std::multimap<std::uint32_t, PendingRequest> pending_requests_;  // requests that wait for the loop's reply,
                                                                   // by their id in the loop
  std::map<ClientId, Client> clients_;
  std::map<ClientId, Watch> watches_;
  std::optional<LoadingStart> loading_;
  StartLedger starts_;
  std::optional<Listing> listing_;
};

}  // namespace softgrip::daemon
