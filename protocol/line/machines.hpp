// Many machines in one session: `open`, `step`, `restart`. They are a vector environment whose machines run
// in slices of time, on the server's threads, and whose results are text.
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

class Session;

std::span<const std::string_view> autoresets();  // their names, as Autoreset counts

class Machines {
 public:
  explicit Machines(Session& session);  // which outlives them
  ~Machines();
  Machines(const Machines&) = delete;
  Machines& operator=(const Machines&) = delete;

  bool empty() const { return opened_ == nullptr; }
  std::size_t size() const;
  Environment& machine(std::size_t number);
  Pacer& pacer(std::size_t number);  // on which that machine runs
  void close();
  void observe(const std::vector<Field>& fields);                 // throws Refusal, and changes nothing
  void rest();                                                    // gives back memory that only saves time
  std::size_t footprint(const std::vector<Field>& fields) const;  // bytes of memory, about

  // Each appends its reply to session.out. All throw Refusal; `open` then leaves the machines that were
  // there.
  void open(std::size_t count, const SlotSettings& settings, Autoreset autoreset);
  void step(std::span<const Act> acts);  // one each
  // Those that are not 0; with a seed, or -1 for none, for each.
  void restart(std::span<const std::uint8_t> chosen, std::span<const std::int64_t> seeds);

 private:
  class Host;
  struct Opened;

  std::size_t check(const std::vector<Field>& fields, std::size_t count, Autoreset autoreset);
  void check_frames(std::int64_t acts, std::span<const std::uint8_t> resets) const;
  void append_texts();

  Session& session_;
  std::unique_ptr<Opened> opened_;
};

}  // namespace racebeam
