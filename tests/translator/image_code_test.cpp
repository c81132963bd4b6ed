// Machines share the code of their image.
#include "emulator/translator/image_code.hpp"

#include <catch2/catch.hpp>
#include <limits>

#include "emulator/translator/code_owner.hpp"

using namespace racebeam;
using racebeam::translator::ImageCode;

TEST_CASE("Code is shared by all images of the same bytes and wiring, while a machine has it") {
  const Rom image(4096, 0xEA), copy(4096, 0xEA), other(4096, 0xE8);
  const translator::Wiring wiring{1, nullptr}, otherwise{2, nullptr};
  CHECK(ImageCode::of(image, wiring, false) == nullptr);
  auto code = ImageCode::of(image, wiring, true);
  REQUIRE(code != nullptr);
  CHECK(ImageCode::of(copy, wiring, false) == code);
  CHECK(ImageCode::of(copy, wiring, true) == code);
  CHECK(ImageCode::of(other, wiring, false) == nullptr);
  CHECK(ImageCode::of(image, otherwise, false) == nullptr);
  code.reset();
  CHECK(ImageCode::of(image, wiring, false) == nullptr);
}

namespace {

constexpr std::size_t kNoLimit = std::numeric_limits<std::size_t>::max();

// Makes views as the banks of a large image are seen, at several mirrors.
std::size_t views_of(ImageCode& code, const Rom& rom) {
  std::size_t count = 0;
  for (const std::uint16_t first : std::initializer_list<std::uint16_t>{0x1000, 0x3000, 0x5000}) {
    for (std::size_t bank = 0; bank + 2048 <= rom.size(); bank += 2048)
      count += code.view({rom.data() + bank, first, 2048}, rom, true) != nullptr;
  }
  return count;
}

}  // namespace

TEST_CASE("Views of an image count, and those of shared images are bounded in all") {
  const Rom image(512U << 10, 0xEA);
  const translator::Wiring wiring{1, nullptr};
  limit_shared_code(2U << 20);
  {
    auto code = ImageCode::of(image, wiring, true);
    REQUIRE(code != nullptr);
    const std::size_t before = views_of(*code, image);
    CHECK(before > 10);
    CHECK(before < 100);
    CHECK(shared_code() <= 2U << 20);
    const auto other = std::make_shared<const Rom>(512U << 10, 0xE8);
    CHECK(ImageCode::of(*other, wiring, true) == nullptr);  // it does not fit
    const CodeOwner owner(other);
    CHECK(owner.bytes() == 0);
    const auto own = ImageCode::of(*other, wiring, true);
    REQUIRE(own != nullptr);
    CHECK(views_of(*own, *other) > before);
    CHECK(owner.bytes() > 4U << 20);
    CHECK(owner.bytes() < 5U << 20);
    CHECK(shared_code() <= 2U << 20);
  }
  CHECK(shared_code() == 0);
  limit_shared_code(kNoLimit);
}
