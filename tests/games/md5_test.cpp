#include <catch2/catch.hpp>

#include <array>
#include <string_view>
#include <vector>

#include "games/md5.hpp"

using namespace racebeam;

namespace {

std::string md5_of_text(std::string_view text) {
  return md5_of({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

std::vector<std::uint8_t> numbers(std::size_t count) {
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i < count; ++i) bytes.push_back(static_cast<std::uint8_t>(7 * i + 3));
  return bytes;
}

struct Sum {
  std::size_t length;
  const char* md5;
};

// Of numbers(length), as Python's hashlib computes them. A block has 64 bytes, and the end takes 9 at least.
constexpr Sum kSums[] = {
    {55, "52c0e574e1198de5fe3f8f11440dcb1b"},  {56, "46c9907fc908ee68b1e7b8e71286a518"},
    {57, "1c805dd236c35cab25fcb1bc73802c51"},  {58, "bca54f0684135200890418305d71acac"},
    {59, "01344f4f53fcb77c6f85b7c808411ee8"},  {60, "88cedcdc923e0dc7346f92cc4cee4179"},
    {61, "0fae1a833824da26a06af17d24b5e783"},  {62, "8eece4c814dc5eb0d6722df349794fe0"},
    {63, "a62f6d59e837867693f042f5b8f5a236"},  {64, "7160b8fb5e9e4023d549c3971fbaeead"},
    {65, "70bd662e7aefbda85a0f7244167b7897"},  {119, "e84905d4214f4d1ca56c2cdcc152b143"},
    {120, "e3eb5a6c8669ea01a8c185b8abc8a5dc"}, {121, "82f02aff7c685d5ef5f6abdfc38fd04f"},
    {122, "3264d4667a3f9b010916fdae50703f40"}, {123, "0134c9c6cc77c9406fee9f9ab05e226f"},
    {124, "30b6c4313c98897e504387b98777ac6d"}, {125, "55580346bc5457bde04f67ce8a5b0df5"},
    {126, "5e1ada0df43aedbcf8b20751d806693e"}, {127, "acce2474d6cc8302120d09c818d17ef7"},
    {128, "10b2da1a82f16d99a81a7203fe9f02cb"}, {129, "03fefbbcebe2959cf2270241aafe0250"}};

}  // namespace

TEST_CASE("MD5 has the values of RFC 1321") {
  CHECK(md5_of_text("") == "d41d8cd98f00b204e9800998ecf8427e");
  CHECK(md5_of_text("a") == "0cc175b9c0f1b6a831c399e269772661");
  CHECK(md5_of_text("abc") == "900150983cd24fb0d6963f7d28e17f72");
  CHECK(md5_of_text("message digest") == "f96b697d7cb7938d525a2f31aaf161d0");
  CHECK(md5_of_text("abcdefghijklmnopqrstuvwxyz") == "c3fcd3d76192e4007dfb496cca67e13b");
  CHECK(md5_of_text("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789") ==
        "d174ab98d277d9f5a5611c2c9f419d9f");
  CHECK(md5_of_text("1234567890123456789012345678901234567890123456789012345678901234567890"
                    "1234567890") == "57edf4a22be3c955ac49da2e2107b67a");
}

TEST_CASE("MD5 is right where the end begins a new block") {
  for (const Sum& sum : kSums) {
    INFO(sum.length << " bytes");
    CHECK(md5_of(numbers(sum.length)) == sum.md5);
  }
}
