#include "server/access/tls.hpp"

#include <openssl/ssl.h>

#include <stdexcept>

#include "system/input_file.hpp"

namespace racebeam {

namespace ssl = boost::asio::ssl;
using boost::system::error_code;

Tls::Tls(std::string certificate, std::string key)
    : certificate_(std::move(certificate)), key_(std::move(key)), context_(read()) {}

void Tls::read_again() {
  auto context = read();
  const std::lock_guard lock(mutex_);
  context_.swap(context);
}

std::shared_ptr<ssl::context> Tls::context() const {
  const std::lock_guard lock(mutex_);
  return context_;
}

std::shared_ptr<ssl::context> Tls::read() const {
  auto context = std::make_shared<ssl::context>(ssl::context::tls_server);
  context->set_options(ssl::context::no_tlsv1 | ssl::context::no_tlsv1_1 | ssl::context::no_compression);
  // A server cannot ask anyone for the password of a key.
  context->set_password_callback([](std::size_t, ssl::context::password_purpose) { return std::string(); });
  error_code error;
  constexpr std::size_t kLargestFile = 1 << 20;
  const std::string certificate = read_input_file("cannot use the certificate", certificate_, kLargestFile);
  const std::string key = read_input_file("cannot use the key", key_, kLargestFile);
  context->use_certificate_chain(boost::asio::buffer(certificate), error);
  if (error) throw std::runtime_error("cannot use the certificate " + certificate_ + ": " + error.message());
  context->use_private_key(boost::asio::buffer(key), ssl::context::pem, error);
  if (error) throw std::runtime_error("cannot use the key " + key_ + ": " + error.message());
  // When OpenSSL loads a key of another type than the certificate's, it does not compare the two.
  if (SSL_CTX_check_private_key(context->native_handle()) != 1)
    throw std::runtime_error("the key " + key_ + " does not belong to the certificate " + certificate_);
  return context;
}

}  // namespace racebeam
