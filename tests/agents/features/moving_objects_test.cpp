#include "agents/features/moving_objects.hpp"

#include <catch2/catch.hpp>

#include "tests/agents/features/drawn_screen.hpp"

using namespace racebeam;
using namespace racebeam::test;

namespace {

const Pattern kBird = {"#   ", " ## ", "  ##"};

}  // namespace

TEST_CASE("A shape has four mirror images, and differs from others by pixels") {
  const Shape bird = shape_of(kBird);
  CHECK(mirrored(bird, 0) == bird);
  CHECK(mirrored(bird, 1) == shape_of({"   #", " ## ", "##  "}));
  CHECK(mirrored(bird, 2) == shape_of({"  ##", " ## ", "#   "}));
  CHECK(mirrored(bird, 3) == shape_of({"##  ", " ## ", "   #"}));
  CHECK(mirrored(mirrored(bird, 3), 3) == bird);
  CHECK(difference(bird, bird) == 0);
  CHECK(difference(bird, mirrored(bird, 1)) == 6);
  CHECK(difference(shape_of({"###", "###", "###"}), shape_of({"#"})) == 8);
  CHECK(difference(shape_of({"#"}), shape_of({"###", "###", "###"})) == 8);
  CHECK(key_of(bird) != key_of(mirrored(bird, 1)));
}

TEST_CASE("An object has the velocity with which it came from the nearest like it") {
  MovingObjects objects({}, 8);
  objects.see(DrawnScreen().draw(50, 60, kBird).pixels);
  REQUIRE(objects.objects().all().size() == 1);
  CHECK(!objects.objects().all()[0].velocity);
  objects.see(DrawnScreen().draw(58, 52, kBird).draw(100, 60, kBird).pixels);
  REQUIRE(objects.objects().all().size() == 2);
  CHECK(objects.objects().all()[0].velocity == Velocity{8, -8});
  CHECK(!objects.objects().all()[1].velocity);  // too far away
  objects.see(DrawnScreen().draw(67, 52, kBird).draw(100, 60, {"####", "####", "####"}).pixels);
  CHECK(!objects.objects().all()[0].velocity);  // nine pixels
  CHECK(!objects.objects().all()[1].velocity);  // another shape
  objects.see(DrawnScreen().draw(67, 61, kBird).pixels);
  CHECK(!objects.objects().all()[0].velocity);  // nine pixels down
  objects.forget();
  objects.see(DrawnScreen().draw(67, 61, kBird).pixels);
  CHECK(!objects.objects().all()[0].velocity);
}

TEST_CASE("Of two objects of the same shape, an object was the nearer one") {
  for (const bool mirrored : {false, true}) {
    const int near = mirrored ? 48 : 52, far = mirrored ? 55 : 45;
    MovingObjects objects({}, 8);
    objects.see(DrawnScreen().draw(near, 61, kBird).draw(far, 61, kBird).pixels);
    objects.see(DrawnScreen().draw(50, 60, kBird).pixels);
    CHECK(objects.objects().all()[0].velocity == Velocity{50 - near, -1});
    objects.see(DrawnScreen().draw(50, 53, kBird).draw(51, 65, kBird).pixels);
    objects.see(DrawnScreen().draw(50, 60, kBird).pixels);
    CHECK(objects.objects().all()[0].velocity == Velocity{-1, -5});
  }
}

TEST_CASE("A shape of which a tenth has changed is the same object, of which more has is not") {
  MovingObjects objects({}, 8);
  const Pattern block = {"#####", "#####", "#####", "#####"};
  objects.see(DrawnScreen().draw(50, 60, block).pixels);
  objects.see(DrawnScreen().draw(52, 60, {"#### ", "#####", "#####", " ####"}).pixels);
  CHECK(objects.objects().all()[0].velocity == Velocity{2, 0});
  objects.see(DrawnScreen().draw(54, 60, block).pixels);
  objects.see(DrawnScreen().draw(54, 60, {"#### ", "#####", "#####", "  ###"}).pixels);
  CHECK(!objects.objects().all()[0].velocity);
}

TEST_CASE("The same shape is preferred to a nearer one that is similar") {
  MovingObjects objects({}, 8);
  const Pattern block = {"#####", "#####"}, dented = {"#### ", "#####"};
  objects.see(DrawnScreen().draw(50, 60, dented).draw(50, 66, block).pixels);
  objects.see(DrawnScreen().draw(50, 61, block).pixels);
  CHECK(objects.objects().all()[0].velocity == Velocity{0, -5});
}

TEST_CASE("Neighbours that move alike are one object, and others are not") {
  const auto screen = [](int x, int legs) {
    return DrawnScreen().draw(x, 20, {" ## ", "####"}, 3).draw(legs, 22, {"#  #", "#  #"}, 4).pixels;
  };
  MovingObjects objects({}, 8);
  objects.see(screen(40, 40));
  CHECK(objects.objects().all().size() == 3);  // a body and two legs, of which nothing is known yet
  objects.see(screen(41, 41));
  REQUIRE(objects.objects().all().size() == 1);
  const ScreenObject& walker = objects.objects().all()[0];
  const ShapeView shape = objects.objects().shape(walker);
  CHECK(Shape(shape.begin(), shape.end()) == shape_of({" ## ", "####", "#  #", "#  #"}));
  CHECK((walker.area == 10 && walker.velocity == Velocity{1, 0} && walker.part_count == 3));
  CHECK(objects.part(walker.first_part).area == 6);
  objects.see(screen(42, 43));  // the legs are faster
  CHECK(objects.objects().all().size() == 3);
}

TEST_CASE("Neighbours in a row are joined without a seam") {
  MovingObjects objects({}, 8);
  for (const int x : {10, 11})
    objects.see(DrawnScreen().draw(x, 5, {"##"}, 3).draw(x + 2, 5, {"##"}, 4).pixels);
  REQUIRE(objects.objects().all().size() == 1);
  CHECK(objects.objects().all()[0].key == key_of(shape_of({"####"})));
}
