#include "racebeam/image.hpp"

#include "library/internals.hpp"

namespace racebeam::v0 {

Image::Image(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}

Image Image::load(const std::string& where) {
  return guarded(Error::Cause::kImage, [&] { return Internals::wrap(load_image(where)); });
}

Image Image::from_bytes(std::span<const std::uint8_t> bytes, const std::string& name) {
  return guarded(Error::Cause::kImage, [&] {
    return Internals::wrap(make_image({bytes.begin(), bytes.end()}, name));
  });
}

std::vector<std::string> Image::built_in() {
  std::vector<std::string> names;
  for (const BuiltInImage& image : builtin_images()) names.emplace_back(image.name);
  return names;
}

const std::string& Image::name() const noexcept { return impl_->image->stem; }
const std::string& Image::md5() const noexcept { return impl_->image->md5; }
std::span<const std::uint8_t> Image::bytes() const noexcept { return impl_->image->file(); }

}  // namespace racebeam::v0
