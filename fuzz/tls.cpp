// The records of a TLS client, which the input alters. After the first byte, which says how they are cut,
// five bytes are one alteration: of which flight, where in it (low byte first), the operation, and the value.
// OpenSSL is not instrumented: the target checks what the server makes of it.
#include <openssl/ssl.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>  // needed by Asio 1.74
#include <vector>

#include <boost/asio.hpp>
#include <boost/asio/ssl.hpp>

#include "fuzz/support/connection.hpp"
#include "fuzz/support/memory_file.hpp"
#include "fuzz/support/target.hpp"
#include "server/access/tls.hpp"

namespace racebeam::fuzz {
namespace {

namespace net = boost::asio;
using boost::system::error_code;

constexpr std::string_view kRequests = "hello token=0123456789abcdef\nload beamfall\nact 0*60\n";
constexpr int kMaxFlights = 8;

template <auto kFree>
struct Freed {
  template <typename T>
  void operator()(T* what) const {
    kFree(what);
  }
};
using Key = std::unique_ptr<EVP_PKEY, Freed<EVP_PKEY_free>>;
using Certificate = std::unique_ptr<X509, Freed<X509_free>>;
using Memory = std::unique_ptr<BIO, Freed<BIO_free>>;

std::string text_in(BIO* memory) {
  char* text = nullptr;
  const auto size = static_cast<std::size_t>(BIO_get_mem_data(memory, &text));
  return {text, size};
}

// The certificate and the key of a server, made anew in each process.
Tls make_tls() {
  const Key key(EVP_EC_gen("P-256"));
  const Certificate certificate(X509_new());
  X509_set_version(certificate.get(), 2);
  ASN1_INTEGER_set(X509_get_serialNumber(certificate.get()), 1);
  X509_gmtime_adj(X509_getm_notBefore(certificate.get()), -3600);
  X509_gmtime_adj(X509_getm_notAfter(certificate.get()), 3600L * 24 * 365);
  X509_set_pubkey(certificate.get(), key.get());
  require(X509_sign(certificate.get(), key.get(), EVP_sha256()) > 0, "a certificate can be made");
  const Memory certificate_text(BIO_new(BIO_s_mem())), key_text(BIO_new(BIO_s_mem()));
  PEM_write_bio_X509(certificate_text.get(), certificate.get());
  PEM_write_bio_PrivateKey(key_text.get(), key.get(), nullptr, nullptr, 0, nullptr, nullptr);
  const MemoryFile certificate_file(text_in(certificate_text.get())), key_file(text_in(key_text.get()));
  return {certificate_file.path(), key_file.path()};
}

// The client's end. It sends its requests when the handshake is done.
class Client {
 public:
  Client() : context_(SSL_CTX_new(TLS_client_method())), ssl_(SSL_new(context_.get())) {
    from_server_ = BIO_new(BIO_s_mem());
    to_server_ = BIO_new(BIO_s_mem());
    SSL_set_bio(ssl_.get(), from_server_, to_server_);  // which owns them
    SSL_set_connect_state(ssl_.get());
  }

  // What the client sends after it has received these bytes.
  std::string flight(std::string_view received) {
    BIO_write(from_server_, received.data(), static_cast<int>(received.size()));
    if (SSL_do_handshake(ssl_.get()) == 1 && !has_asked_) {
      has_asked_ = true;
      SSL_write(ssl_.get(), kRequests.data(), static_cast<int>(kRequests.size()));
    }
    std::string bytes = text_in(to_server_);
    (void)BIO_reset(to_server_);
    return bytes;
  }

 private:
  std::unique_ptr<SSL_CTX, Freed<SSL_CTX_free>> context_;
  std::unique_ptr<SSL, Freed<SSL_free>> ssl_;
  BIO *from_server_, *to_server_;
  bool has_asked_ = false;
};

struct Alteration {
  unsigned flight, place, operation, value;
};

std::vector<Alteration> alterations(Reader& reader) {
  std::vector<Alteration> all;
  while (!reader.empty()) {
    const unsigned flight = reader.byte(), place = reader.word(), operation = reader.byte();
    all.push_back({flight % 2, place, operation % 4, reader.byte()});  // a handshake has two flights
  }
  return all;
}

// Returns whether the flight has other bytes than before.
bool alter(std::string& flight, const Alteration& change) {
  if (flight.empty()) return false;
  const std::string before = flight;
  const std::size_t place = change.place % flight.size();
  const auto value = static_cast<char>(change.value);
  switch (change.operation) {
    case 0: flight[place] = value; break;
    case 1: flight[place] = static_cast<char>(flight[place] ^ value); break;
    case 2: flight.insert(place, 1, value); break;
    default: flight.erase(place, 1 + change.value);
  }
  return flight != before;
}

struct Outcome {
  std::string text;  // that the server has read
  bool has_ended = false;
};

Task<> serve(ByteStream::Socket& socket, std::shared_ptr<net::ssl::context> context, Outcome& outcome) {
  ByteStream::TlsStream tls(socket, *context);
  error_code error;
  co_await tls.async_handshake(net::ssl::stream_base::server, net::redirect_error(use_task, error));
  ByteStream stream(tls);
  std::string part(64, '\0');
  while (!error) {
    const std::size_t count =
        co_await stream.async_read_some(net::buffer(part), net::redirect_error(use_task, error));
    outcome.text.append(part, 0, count);
  }
  outcome.has_ended = true;
}

}  // namespace

void run(Bytes input) {
  static const Tls tls = make_tls();
  Reader reader(input);
  const std::size_t piece = 1 + 8 * std::size_t{reader.byte()};
  const std::vector<Alteration> changes = alterations(reader);
  Outcome outcome;
  Connection connection;
  connection.serve(serve(connection.socket(), tls.context(), outcome));
  Client client;
  bool altered = false;
  for (unsigned number = 0; number < kMaxFlights; ++number) {
    std::string flight = client.flight(connection.answers());
    if (flight.empty()) break;
    for (const Alteration& change : changes)
      if (change.flight == number) altered = alter(flight, change) || altered;
    connection.forget_answers();
    connection.say(flight, piece);
  }
  connection.end();
  require(outcome.has_ended, "a connection ends when the client has ended");
  require(kRequests.starts_with(outcome.text), "only what the client has encrypted is read", outcome.text);
  if (!altered) require(outcome.text == kRequests, "all that the client has encrypted is read", outcome.text);
}

}  // namespace racebeam::fuzz
