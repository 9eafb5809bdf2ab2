// Grips a part and waits for the grip result. `grip_and_wait SOCKET SEQUENCE` sends requests to softgripd
// (docs/reference/socket-api.md). Exit code 0: HOLDING was reported before the end of the sequence; 1:
// HOLDING was not reported, or an error occurred. Each line that softgripd sends is a JSON object; a larger
// program should parse the lines with a JSON library.

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstdio>
#include <stdexcept>
#include <string>

class Daemon {
 public:
  explicit Daemon(const std::string& path) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.copy(address.sun_path, sizeof address.sun_path - 1);
    if (socket_ < 0 || ::connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0)
      throw std::runtime_error("softgripd does not listen on " + path);
  }
  Daemon(const Daemon&) = delete;
  Daemon& operator=(const Daemon&) = delete;
  ~Daemon() { ::close(socket_); }

  void send(const std::string& request) const {
    const std::string line = request + "\n";
    if (::send(socket_, line.data(), line.size(), MSG_NOSIGNAL) != static_cast<ssize_t>(line.size()))
      throw std::runtime_error("the connection to softgripd is lost");
  }
  std::string line() {
    std::size_t end = 0;
    while ((end = received_.find('\n')) == std::string::npos) {
      char bytes[4096];
      const ssize_t count = ::read(socket_, bytes, sizeof bytes);
      if (count <= 0) throw std::runtime_error("the connection to softgripd is lost");
      received_.append(bytes, static_cast<std::size_t>(count));
    }
    const std::string line = received_.substr(0, end);
    received_.erase(0, end + 1);
    return line;
  }

 private:
  int socket_ = ::socket(AF_UNIX, SOCK_STREAM, 0);
  std::string received_;
};

/// Returns the text value of a key in a JSON line; empty if the line does not contain the key.
std::string text_of(const std::string& line, const std::string& key) {
  std::size_t at = line.find("\"" + key + "\"");
  if (at == std::string::npos) return "";
  at = line.find_first_not_of(" :", at + key.size() + 2);
  if (at == std::string::npos || line[at] != '"') return "";
  return line.substr(at + 1, line.find('"', at + 1) - at - 1);
}

int main(int count, char** arguments) try {
  if (count != 3) {
    std::fprintf(stderr, "usage: grip_and_wait SOCKET SEQUENCE\n");
    return 2;
  }
  Daemon daemon(arguments[1]);
  daemon.send(R"({"id": 1, "command": "subscribe"})");
  daemon.send(R"({"id": 2, "command": "start", "sequence": ")" + std::string(arguments[2]) + "\"}");
  for (bool held = false;;) {
    const std::string line = daemon.line();
    if (const std::string problem = text_of(line, "message"); !problem.empty())
      throw std::runtime_error(problem);
    const std::string kind = text_of(line, "kind"), code = text_of(line, "code");
    if (kind == "overall_result") std::printf("result: %s\n", code.c_str());
    held = held || (kind == "overall_result" && code == "HOLDING");
    if (kind == "sequence_finished") return held ? 0 : 1;
  }
} catch (const std::exception& error) {
  std::fprintf(stderr, "grip_and_wait: %s\n", error.what());
  return 1;
}
