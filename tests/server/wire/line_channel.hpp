// One end of a connection, of a client or an echo server: blocking descriptors and lines.
#pragma once

#include <sys/types.h>

#include <string>
#include <string_view>
#include <vector>

namespace wire {

class LineChannel {
 public:
  LineChannel(int in, int out) : in_(in), out_(out) {}

  void send(std::string_view text) const { send(out_, text); }
  static void send(int descriptor, std::string_view text);  // throws std::runtime_error
  // The next line with its LF, valid until the next call; empty at the end.
  std::string_view line();

 private:
  int in_, out_;
  std::string buffer_ = std::string(1 << 16, '\0');
  std::size_t begin_ = 0, end_ = 0;
};

// Processes run where the system places them. After put_apart(), the caller and its servers have a processor
// each.
void put_apart();
void run_as_server();  // in a child that was forked; start() does so itself

// Starts a program whose standard input and output are `in` and `out` of a channel.
struct Child {
  pid_t process;
  int in, out;
};
Child start(const std::vector<std::string>& command);
void stop(const Child& child);  // closes its streams and waits for its end

int connect_unix(const std::string& path);
int connect_tcp(int port);
int listen_unix(const std::string& path);
int listen_tcp(int& port);  // of 127.0.0.1; sets the port that was picked
int accept_one(int listener);

double now();  // seconds

}  // namespace wire
