// The certificate that a server shows, and its key.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <utility>  // Asio 1.74 forgets it

#include <boost/asio/ssl/context.hpp>

namespace racebeam {

class Tls {
 public:
  // PEM files: a chain of certificates, the server's first, and its key. TLS 1.2 and later are spoken.
  // Throws std::runtime_error with a sentence.
  Tls(std::string certificate, std::string key);

  void read_again();  // throws like the constructor; what was before stays then

  // For a connection that begins; it keeps it for as long as it lasts.
  std::shared_ptr<boost::asio::ssl::context> context() const;

 private:
  std::shared_ptr<boost::asio::ssl::context> read() const;

  std::string certificate_, key_;
  mutable std::mutex mutex_;
  std::shared_ptr<boost::asio::ssl::context> context_;
};

}  // namespace racebeam
