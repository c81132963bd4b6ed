// The machines of `open`, `step` and `restart`: a vector environment that runs on the server's threads in
// slices of time, and writes its results as text.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "environment/vector/vector_environment.hpp"
#include "protocol/line/field.hpp"
#include "protocol/running/pacer.hpp"

namespace racebeam {

class Context;
class Reply;

class Machines {
 public:
  explicit Machines(Context& context);  // must outlive the machines
  ~Machines();
  Machines(const Machines&) = delete;
  Machines& operator=(const Machines&) = delete;

  bool empty() const { return opened_ == nullptr; }
  std::size_t size() const;
  Slot& slot(std::size_t number);
  Pacer& pacer(std::size_t number);  // paces this machine
  void close();
  // What machine=TEXT means in a request. Throws RequestError for an unknown machine.
  std::size_t number_of(std::string_view text) const;
  void add_view(std::size_t number, Reply& reply);  // what this machine shows
  void observe(const std::vector<Field>& fields);   // may throw RequestError, and changes nothing then
  void release_caches();
  std::size_t footprint() const;  // bytes of memory

  // Each writes its reply. All may throw RequestError; `open` then keeps the machines that
  // were there.
  void open(std::size_t count, const SlotSettings& settings, Autoreset autoreset, Reply& reply);
  void step(std::span<const Act> acts, Reply& reply);  // one for each machine
  // Resets the machines whose byte in `mask` is not 0. There is a seed for each machine; -1: none.
  void restart(std::span<const std::uint8_t> mask, std::span<const std::int64_t> seeds, Reply& reply);

 private:
  class Host;
  struct Opened;

  std::size_t check(const std::vector<Field>& fields, std::size_t count, Autoreset autoreset);
  void check_frames(std::int64_t acts, std::span<const std::uint8_t> resets) const;
  void check_reply_memory() const;
  void add_texts(Reply& reply);

  Context& context_;
  std::unique_ptr<Opened> opened_;
};

}  // namespace racebeam
