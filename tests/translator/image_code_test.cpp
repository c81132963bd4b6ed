// Machines share the code of their image.
#include "emulator/translator/image_code.hpp"

#include <catch2/catch.hpp>

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
