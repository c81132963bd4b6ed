/// @file
/// The bytes of a session: sockets, TLS, pipes, and a server that the session starts. One coroutine at a time
/// uses a Connection.
#pragma once

#include <utility>  // before Boost.Asio 1.74, which lacks it

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/buffer.hpp>
#include <boost/asio/connect.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/local/connect_pair.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>
#ifndef RACEBEAM_CLIENT_WITHOUT_TLS
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/ssl/host_name_verification.hpp>
#include <boost/asio/ssl/stream.hpp>
#endif

#include <cerrno>
#include <chrono>
#include <csignal>
#include <future>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "racebeam/client/address.hpp"
#include "racebeam/client/config.hpp"
#include "racebeam/client/options.hpp"

extern char** environ;  // NOLINT(readability-redundant-declaration): POSIX has it in no header

namespace RACEBEAM_CLIENT_NAMESPACE::detail {

namespace asio = boost::asio;

/// Bytes to and from a server. What fails throws boost::system::system_error.
class Connection {
 public:
  virtual ~Connection() = default;
  virtual asio::awaitable<void> open() = 0;
  virtual asio::awaitable<std::size_t> read(asio::mutable_buffer into) = 0;
  virtual asio::awaitable<void> write(asio::const_buffer data) = 0;
  /// What waits fails. Further calls do nothing. It does not block.
  virtual void close() noexcept = 0;
  /// After close(): waits for the end of a process that was started for the connection.
  virtual void await_end() noexcept {}
};

/// A connection over one stream of Boost.Asio. `open` is left to each kind.
template <class Stream>
class StreamConnection : public Connection {
 public:
  asio::awaitable<std::size_t> read(asio::mutable_buffer into) final {
    return stream_.async_read_some(into, asio::use_awaitable);
  }

  asio::awaitable<void> write(asio::const_buffer data) final {
    co_await asio::async_write(stream_, data, asio::use_awaitable);
  }

  void close() noexcept override {
    boost::system::error_code ignored;
    stream_.lowest_layer().close(ignored);
  }

 protected:
  template <class... Arguments>
  explicit StreamConnection(Arguments&&... arguments) : stream_(std::forward<Arguments>(arguments)...) {}

  Stream stream_;
};

/// A connection over TCP. Connects to the first of a host's addresses that answers.
template <class Stream>
class NetworkConnection : public StreamConnection<Stream> {
 public:
  void close() noexcept final {
    closed_ = true;
    StreamConnection<Stream>::close();
  }

 protected:
  template <class... Arguments>
  explicit NetworkConnection(Address address, Arguments&&... arguments)
      : StreamConnection<Stream>(std::forward<Arguments>(arguments)...), address_(std::move(address)) {
    boost::system::error_code is_name;
    number_ = asio::ip::make_address(address_.place, is_name);
    has_name_ = static_cast<bool>(is_name);
  }

  asio::awaitable<void> connect(asio::ip::tcp::socket& socket) {
    using asio::ip::tcp;
    if (has_name_) {
      tcp::resolver resolver(socket.get_executor());
      const auto found =
          co_await resolver.async_resolve(address_.place, std::to_string(address_.port), asio::use_awaitable);
      if (closed_) throw boost::system::system_error(asio::error::operation_aborted);
      co_await asio::async_connect(socket, found, asio::use_awaitable);
    } else {
      co_await socket.async_connect(tcp::endpoint(number_, address_.port), asio::use_awaitable);
    }
    socket.set_option(tcp::no_delay(true));
  }

  Address address_;
  bool has_name_ = false;  // rather than a number

 private:
  asio::ip::address number_;
  bool closed_ = false;
};

class TcpConnection final : public NetworkConnection<asio::ip::tcp::socket> {
 public:
  TcpConnection(const asio::any_io_executor& executor, Address address)
      : NetworkConnection(std::move(address), executor) {}

  asio::awaitable<void> open() override { return connect(stream_); }
};

#ifndef RACEBEAM_CLIENT_WITHOUT_TLS
/// A context of TLS 1.2 or later that checks certificates. It comes before the stream that refers to it.
class TlsContext {
 protected:
  explicit TlsContext(const std::string& authorities) {
    using asio::ssl::context_base;
    context_.set_options(context_base::default_workarounds | context_base::no_tlsv1 |
                         context_base::no_tlsv1_1);
    context_.set_verify_mode(asio::ssl::verify_peer);
    boost::system::error_code failure;
    if (authorities.empty()) {
      context_.set_default_verify_paths(failure);
    } else {
      context_.load_verify_file(authorities, failure);
    }
    if (failure)
      throw std::invalid_argument(std::string("cannot use the certificates of '")
                                      .append(authorities)
                                      .append("': ")
                                      .append(failure.message()));
  }

  asio::ssl::context context_{asio::ssl::context::tls_client};
};

class TlsConnection final : private TlsContext,
                            public NetworkConnection<asio::ssl::stream<asio::ip::tcp::socket>> {
 public:
  TlsConnection(const asio::any_io_executor& executor, Address address, const std::string& authorities)
      : TlsContext(authorities), NetworkConnection(std::move(address), executor, context_) {
    stream_.set_verify_callback(asio::ssl::host_name_verification(address_.place));
  }

  asio::awaitable<void> open() override {
    co_await connect(stream_.next_layer());
    if (has_name_)
      ::SSL_ctrl(stream_.native_handle(), SSL_CTRL_SET_TLSEXT_HOSTNAME, TLSEXT_NAMETYPE_host_name,
                 address_.place.data());
    co_await stream_.async_handshake(asio::ssl::stream_base::client, asio::use_awaitable);
  }
};
#endif

class UnixConnection final : public StreamConnection<asio::local::stream_protocol::socket> {
 public:
  UnixConnection(const asio::any_io_executor& executor, const std::string& path)
      : StreamConnection(executor), path_(path) {}

  asio::awaitable<void> open() override {
    co_await stream_.async_connect(asio::local::stream_protocol::endpoint(path_), asio::use_awaitable);
  }

 private:
  std::string path_;
};

/// A process that speaks the protocol on its standard streams, which are a socket. It ends when its input
/// does.
class ProcessConnection final : public StreamConnection<asio::local::stream_protocol::socket> {
 public:
  ProcessConnection(const asio::any_io_executor& executor, std::vector<std::string> command)
      : StreamConnection(executor), command_(std::move(command)) {}

  ~ProcessConnection() override { close(); }  // NOLINT(*-virtual-call-in-constructor): the class is final

  asio::awaitable<void> open() override {
    asio::local::stream_protocol::socket theirs(stream_.get_executor());
    asio::local::connect_pair(stream_, theirs);
    ::fcntl(stream_.native_handle(), F_SETFD, FD_CLOEXEC);
    start(theirs.native_handle());
    co_return;
  }

  void close() noexcept override {
    StreamConnection::close();
    const pid_t process = std::exchange(process_, 0);
    if (process <= 0) return;
    try {
      std::packaged_task<void()> task([process] { end(process, kPatience); });
      ended_ = task.get_future();
      std::thread(std::move(task)).detach();
    } catch (const std::exception&) {  // a thread cannot be made
      end(process, {});
    }
  }

  void await_end() noexcept override {
    if (ended_.valid()) ended_.wait();
  }

 private:
  static constexpr std::chrono::seconds kPatience{10};

  /// A process whose input has ended. It is killed if it goes on for longer than `patience`.
  static void end(pid_t process, std::chrono::seconds patience) noexcept {
    const auto until = std::chrono::steady_clock::now() + patience;
    while (::waitpid(process, nullptr, WNOHANG) == 0) {
      if (std::chrono::steady_clock::now() >= until) {
        ::kill(process, SIGKILL);
        ::waitpid(process, nullptr, 0);
        return;
      }
      ::usleep(5'000);
    }
  }

  void start(int socket) {
    std::vector<char*> words;
    for (std::string& word : command_) words.push_back(word.data());
    words.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO})
      ::posix_spawn_file_actions_adddup2(&actions, socket, stream);
    ::posix_spawn_file_actions_addclose(&actions, socket);
    const int failure = ::posix_spawnp(&process_, words[0], &actions, nullptr, words.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    if (failure != 0) {
      process_ = 0;
      throw boost::system::system_error(failure, boost::system::system_category(),
                                        "cannot start " + command_[0]);
    }
  }

  std::vector<std::string> command_;
  pid_t process_ = 0;
  std::future<void> ended_;  // of the process, after close()
};

#if defined(F_SETNOSIGPIPE)
/// Keeps a write to a pipe without reader from raising SIGPIPE. macOS would send it to any thread.
class NoBrokenPipe {
 public:
  explicit NoBrokenPipe(int pipe) : pipe_(pipe), before_(::fcntl(pipe, F_GETNOSIGPIPE)) {
    ::fcntl(pipe_, F_SETNOSIGPIPE, 1);
  }
  ~NoBrokenPipe() {
    if (before_ == 0) ::fcntl(pipe_, F_SETNOSIGPIPE, 0);
  }
  NoBrokenPipe(const NoBrokenPipe&) = delete;
  NoBrokenPipe& operator=(const NoBrokenPipe&) = delete;

 private:
  int pipe_, before_;
};
#else
/// Keeps the calling thread from SIGPIPE, which a write to a pipe without reader raises.
class NoBrokenPipe {
 public:
  explicit NoBrokenPipe(int /*pipe*/) {
    ::sigemptyset(&signal_);
    ::sigaddset(&signal_, SIGPIPE);
    ::pthread_sigmask(SIG_BLOCK, &signal_, &before_);
  }
  ~NoBrokenPipe() {
    if (::sigismember(&before_, SIGPIPE) == 1) return;
    const timespec at_once{};
    ::sigtimedwait(&signal_, nullptr, &at_once);
    ::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }
  NoBrokenPipe(const NoBrokenPipe&) = delete;
  NoBrokenPipe& operator=(const NoBrokenPipe&) = delete;

 private:
  sigset_t signal_{}, before_{};
};
#endif

/// Two descriptors, one for each direction.
class DescriptorConnection : public Connection {
 public:
  asio::awaitable<std::size_t> read(asio::mutable_buffer into) final {
    return in_.async_read_some(into, asio::use_awaitable);
  }

  asio::awaitable<void> write(asio::const_buffer data) final {
    while (data.size() > 0) {
      const std::size_t written = write_some(data);
      data += written;
      if (written == 0)
        co_await out_.async_wait(asio::posix::stream_descriptor::wait_write, asio::use_awaitable);
    }
  }

  void close() noexcept final {
    boost::system::error_code ignored;
    in_.close(ignored);
    out_.close(ignored);
  }

 protected:
  explicit DescriptorConnection(const asio::any_io_executor& executor) : in_(executor), out_(executor) {}

  asio::posix::stream_descriptor in_, out_;

 private:
  /// 0 if nothing can be written now.
  std::size_t write_some(asio::const_buffer data) {
    const NoBrokenPipe guard(out_.native_handle());
    boost::system::error_code failure;
    out_.non_blocking(true);
    const std::size_t written = out_.write_some(data, failure);
    if (failure && failure != asio::error::would_block) throw boost::system::system_error(failure);
    return written;
  }
};

/// The named pipes PREFIX_out and PREFIX_in, which the server opens in this order.
class PipesConnection final : public DescriptorConnection {
 public:
  PipesConnection(const asio::any_io_executor& executor, const std::string& prefix)
      : DescriptorConnection(executor), prefix_(prefix) {}

  asio::awaitable<void> open() override {
    in_.assign(descriptor("_out", O_RDONLY));
    asio::steady_timer pause(in_.get_executor());
    int out = -1;
    while ((out = descriptor("_in", O_WRONLY)) < 0) {  // the server has not opened it yet
      pause.expires_after(std::chrono::milliseconds(5));
      co_await pause.async_wait(asio::use_awaitable);
      if (!in_.is_open()) throw boost::system::system_error(asio::error::operation_aborted);
    }
    out_.assign(out);
  }

 private:
  /// -1 if no process has opened the other end.
  int descriptor(const char* suffix, int mode) const {
    const std::string path = prefix_ + suffix;
    const int opened = ::open(path.c_str(), mode | O_NONBLOCK | O_CLOEXEC);  // NOLINT(*-vararg): POSIX
    if (opened < 0 && errno != ENXIO)
      throw boost::system::system_error(errno, boost::system::system_category(),
                                        "cannot open the pipe " + path);
    return opened;
  }

  std::string prefix_;
};

/// The standard streams of this process.
class StdioConnection final : public DescriptorConnection {
 public:
  explicit StdioConnection(const asio::any_io_executor& executor) : DescriptorConnection(executor) {}

  asio::awaitable<void> open() override {
    in_.assign(::dup(STDIN_FILENO));
    out_.assign(::dup(STDOUT_FILENO));
    co_return;
  }
};

/// A connection that is not open yet. Throws std::invalid_argument if this client cannot use the address.
inline std::unique_ptr<Connection> make_connection(const asio::any_io_executor& executor,
                                                   const Address& address, const Options& options) {
  using Kind = Address::Kind;
  switch (address.kind) {
    case Kind::kTcp: return std::make_unique<TcpConnection>(executor, address);
    case Kind::kTls:
#ifdef RACEBEAM_CLIENT_WITHOUT_TLS
      throw std::invalid_argument(
          "this program was built with RACEBEAM_CLIENT_WITHOUT_TLS; it takes no tls://");
#else
      return std::make_unique<TlsConnection>(executor, address, options.authorities);
#endif
    case Kind::kUnix: return std::make_unique<UnixConnection>(executor, address.place);
    case Kind::kPipes: return std::make_unique<PipesConnection>(executor, address.place);
    case Kind::kStdio: return std::make_unique<StdioConnection>(executor);
  }
  throw std::logic_error("no such kind of address");
}

}  // namespace RACEBEAM_CLIENT_NAMESPACE::detail
