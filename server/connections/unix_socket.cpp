#include "server/connections/unix_socket.hpp"

#include <cerrno>
#include <chrono>
#include <filesystem>
#include <thread>

#include "server/access/address.hpp"
#include "system/file_lock.hpp"
#include "system/program/sockets.hpp"
#include "system/regular_file.hpp"

namespace racebeam {
namespace {

namespace net = boost::asio;
using Unix = net::local::stream_protocol;
using SocketFile = net::detail::sockaddr_un_type;
using boost::system::error_code;

// Removes a socket file that remains after its server has died. Such a file refuses connections.
void remove_stale(const std::string& path) {
  std::error_code unknown;
  if (!std::filesystem::exists(path, unknown)) return;
  if (!std::filesystem::is_socket(path)) throw AddressError(path + " exists, but is not a socket");
  net::io_context context;
  error_code error;
  Unix::socket probe(context, Unix());
  probe.non_blocking(true);  // a busy server has a full queue, for which connect() would wait
  probe.connect(Unix::endpoint(path), error);
  if (error == net::error::connection_refused) std::filesystem::remove(path);
}

// A lock on the folder of a socket. A server that has bound its socket, but does not listen yet, looks dead
// to others. With the lock, the others cannot remove its file then.
class FolderLock {
 public:
  explicit FolderLock(const std::filesystem::path& folder)
      : folder_(open_lock_of_folder(folder.empty() ? "." : folder.string())) {
    const auto end = std::chrono::steady_clock::now() + kLockTimeout;
    while (!lock_file(folder_, Waiting::kNo) && is_locked_elsewhere(errno) &&
           std::chrono::steady_clock::now() < end)
      std::this_thread::sleep_for(kBetweenTries);
  }
  ~FolderLock() {
    if (folder_ >= 0) close_file(folder_);
  }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  // After this time, or if the folder does not support locks, the server goes on without the lock: another
  // program may hold it for long.
  static constexpr std::chrono::seconds kLockTimeout{2};
  static constexpr std::chrono::milliseconds kBetweenTries{5};

  const int folder_;
};

}  // namespace

void bind_unix_socket(const std::string& path, const std::string& name,
                      const std::function<void(const Protocol::endpoint&)>& bind) {
  const std::size_t longest = longest_socket_path();
  if (path.size() > longest) {
    throw AddressError(name + " is too long; a socket's path has at most " + std::to_string(longest) +
                       " bytes");
  }
  const FolderLock lock(std::filesystem::path(path).parent_path());
  remove_stale(path);
  bind(Unix::endpoint(path));
}

std::optional<std::string> unix_path_of(const Protocol::endpoint& endpoint) {
  if (endpoint.protocol().family() != AF_UNIX) return std::nullopt;
  return static_cast<const SocketFile*>(static_cast<const void*>(endpoint.data()))->sun_path;
}

}  // namespace racebeam
