#pragma once
// Runs the Modbus server of libmodbus in a thread.

#include <modbus/modbus.h>
#include <netinet/in.h>
#include <pthread.h>
#include <sched.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <thread>

namespace softgrip::drivers::test {

/// Serves one session after another until the destructor is called.
class LibmodbusServer {
 public:
  LibmodbusServer()
      : context_(::modbus_new_tcp("127.0.0.1", 0)), mapping_(::modbus_mapping_new(64, 64, 512, 64)) {
    ::modbus_set_slave(context_, 1);
    listener_ = ::modbus_tcp_listen(context_, 4);
    sockaddr_in address{};
    socklen_t size = sizeof address;
    ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this] { serve(); });
  }
  LibmodbusServer(const LibmodbusServer&) = delete;
  LibmodbusServer& operator=(const LibmodbusServer&) = delete;
  LibmodbusServer(LibmodbusServer&&) = delete;
  LibmodbusServer& operator=(LibmodbusServer&&) = delete;
  ~LibmodbusServer() {
    ::shutdown(listener_, SHUT_RDWR);
    thread_.join();
    ::close(listener_);
    ::modbus_mapping_free(mapping_);
    ::modbus_free(context_);
  }

  [[nodiscard]] std::uint16_t port() const { return port_; }
  /// Returns the registers of the server. A test may use them only between exchanges, when the server waits
  /// for a request.
  [[nodiscard]] modbus_mapping_t& mapping() { return *mapping_; }
  [[nodiscard]] pthread_t thread() { return thread_.native_handle(); }
  /// Returns the processor on which the server answered the last request.
  [[nodiscard]] int processor() const { return processor_; }

 private:
  void serve() {
    std::array<std::uint8_t, MODBUS_TCP_MAX_ADU_LENGTH> request{};
    while (::modbus_tcp_accept(context_, &listener_) >= 0) {
      for (int size = ::modbus_receive(context_, request.data()); size >= 0;
           size = ::modbus_receive(context_, request.data())) {
        processor_ = ::sched_getcpu();
        ::modbus_reply(context_, request.data(), size, mapping_);
      }
      ::modbus_close(context_);
    }
  }

  modbus_t* context_;
  modbus_mapping_t* mapping_;
  int listener_ = -1;
  std::uint16_t port_ = 0;
  std::atomic<int> processor_ = -1;
  std::thread thread_;
};

}  // namespace softgrip::drivers::test
