#include "environment/saved/saved_state_format.hpp"

#include <algorithm>
#include <cstring>
#include <string>

#include "environment/saved/state_bytes.hpp"
#include "environment/saved_state.hpp"
#include "system/invalid_input.hpp"

namespace racebeam {

using namespace state_bytes;

namespace {

using Values = Environment::Saved::Values;

struct Header {
  char magic[8];
  std::uint32_t version;
  std::uint32_t values_size;  // another compilation of the same version could differ
  std::uint32_t total_size;
  std::uint32_t checksum;  // CRC-32 of everything after the header
};
static_assert(sizeof(Header) == 24);

struct Prefix {
  Identity identity;
  std::int32_t height;  // rows of a picture
  std::uint32_t has_random;
  std::uint32_t cartridge_ram;  // bytes of it

  std::size_t picture_size() const { return static_cast<std::size_t>(height) * kScreenWidth; }
  std::size_t size_of_rest() const {
    return sizeof(Values) + cartridge_ram + 2 * picture_size() +
           (has_random != 0 ? sizeof(GeneratorWords) : 0);
  }
};

constexpr char kMagic[8] = {'R', 'B', 'S', 'T', 'A', 'T', 'E', '\n'};

[[noreturn]] void refuse(const std::string& sentence) { throw InvalidInput(sentence); }

void check(const Header& header, std::size_t size) {
  if (!std::ranges::equal(header.magic, kMagic)) refuse("this is not a state saved by racebeam");
  if (header.version != kSnapshotVersion) {
    refuse("the state was saved by another version of racebeam (format " + std::to_string(header.version) +
           "; this one reads format " + std::to_string(kSnapshotVersion) + ")");
  }
  if (header.values_size != sizeof(Values)) {
    refuse("the state was saved by another build of racebeam (with " + std::to_string(header.values_size) +
           " bytes of values; this one reads " + std::to_string(sizeof(Values)) + ")");
  }
  if (header.total_size != size) {
    refuse("the state has " + std::to_string(size) + " bytes instead of " +
           std::to_string(header.total_size) + "; it was truncated, or bytes were added");
  }
}

void check(const Prefix& prefix, std::size_t size, const Environment& environment) {
  check_identity(prefix.identity, Identity(environment.image(), environment.game()));
  if (prefix.height != environment.height()) {
    refuse("the state's pictures have " + std::to_string(prefix.height) +
           " rows; those of the console that runs have " + std::to_string(environment.height()));
  }
  if (prefix.has_random > 1 || size != prefix.size_of_rest())
    refuse("the state's size contradicts its header");
}

void append_pixels(std::vector<std::uint8_t>& bytes, const FrameBuffer& picture, std::size_t size) {
  const auto pixels = picture.pixels().first(size);
  bytes.insert(bytes.end(), pixels.begin(), pixels.end());
}

std::shared_ptr<FrameBuffer> take_picture(std::span<const std::uint8_t>& bytes, std::size_t size) {
  auto picture = std::make_shared<FrameBuffer>();
  picture->make_room(size / kLinePixels);
  std::ranges::copy(bytes.first(size), picture->pixels().begin());
  bytes = bytes.subspan(size);
  return picture;
}

}  // namespace

std::vector<std::uint8_t> to_bytes(const Environment::Saved& saved, const Environment& environment) {
  check_identity(saved.identity, Identity(environment.image(), environment.game()));
  Prefix prefix{};
  prefix.identity = saved.identity;
  prefix.height = saved.height;
  prefix.has_random = saved.random != nullptr;
  prefix.cartridge_ram = static_cast<std::uint32_t>(saved.cartridge_ram.size());

  std::vector<std::uint8_t> bytes(sizeof(Header));
  bytes.reserve(sizeof(Header) + sizeof(Prefix) + prefix.size_of_rest());
  append(bytes, prefix);
  append(bytes, saved.values);
  bytes.insert(bytes.end(), saved.cartridge_ram.begin(), saved.cartridge_ram.end());
  append_pixels(bytes, *environment.with_pixels(saved.pictures.current), prefix.picture_size());
  append_pixels(bytes, *environment.with_pixels(saved.pictures.previous), prefix.picture_size());
  if (saved.random) append(bytes, words_of(*saved.random));

  Header header{{},
                kSnapshotVersion,
                sizeof(Values),
                static_cast<std::uint32_t>(bytes.size()),
                checksum(std::span(bytes).subspan(sizeof(Header)))};
  std::ranges::copy(kMagic, header.magic);
  std::memcpy(bytes.data(), &header, sizeof header);
  return bytes;
}

std::shared_ptr<const Environment::Saved> from_bytes(std::span<const std::uint8_t> bytes,
                                                     const Environment& environment) {
  if (bytes.size() < sizeof(Header) + sizeof(Prefix))
    refuse("this is not a state saved by racebeam: it is too short");
  const std::size_t size = bytes.size();
  const auto header = take<Header>(bytes);
  check(header, size);
  if (header.checksum != checksum(bytes)) refuse("the state was altered: its checksum is wrong");
  const auto prefix = take<Prefix>(bytes);
  check(prefix, bytes.size(), environment);

  auto saved = std::make_shared<Environment::Saved>();
  saved->identity = prefix.identity;
  saved->properties = environment.game().properties_for(environment.image().md5);
  saved->height = prefix.height;
  saved->values = take<Values>(bytes);
  saved->cartridge_ram.assign(bytes.begin(), bytes.begin() + prefix.cartridge_ram);
  bytes = bytes.subspan(prefix.cartridge_ram);
  saved->pictures.current = take_picture(bytes, prefix.picture_size());
  saved->pictures.previous = take_picture(bytes, prefix.picture_size());
  if (prefix.has_random != 0)
    saved->random = std::make_shared<const MersenneTwister>(generator_of(take<GeneratorWords>(bytes)));
  environment.check(*saved);
  return saved;
}

}  // namespace racebeam
