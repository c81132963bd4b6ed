#include "server/web/byte_stream.hpp"

namespace racebeam {

void ByteStream::start_read(const Space& space, IoHandler done) {
  if (tls_ != nullptr) return tls_->async_read_some(space, std::move(done));
  socket_->async_read_some(space, std::move(done));
}

void ByteStream::start_write(const Bytes& bytes, IoHandler done) {
  if (tls_ != nullptr) return tls_->async_write_some(bytes, std::move(done));
  socket_->async_write_some(bytes, std::move(done));
}

}  // namespace racebeam
