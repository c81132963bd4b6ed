// The server's certificate and its key.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <utility>  // needed by Asio 1.74

#include <boost/asio/ssl/context.hpp>

namespace racebeam {

class Tls {
 public:
  // Reads PEM files: a chain of certificates, the server's first, and its key. Accepts TLS 1.2 and later.
  // Throws std::runtime_error with a sentence.
  Tls(std::string certificate, std::string key);

  void read_again();  // throws like the constructor, and then does not change anything

  // The context for a new connection, which holds it during its lifetime.
  std::shared_ptr<boost::asio::ssl::context> context() const;

 private:
  std::shared_ptr<boost::asio::ssl::context> read() const;

  std::string certificate_, key_;
  mutable std::mutex mutex_;
  std::shared_ptr<boost::asio::ssl::context> context_;
};

}  // namespace racebeam
