#include "system/affinity.hpp"

#include <pthread.h>
#include <sched.h>

#include <cstddef>
#include <memory>
#include <string>
#include <system_error>

#include "system/invalid_input.hpp"

namespace racebeam {
namespace {

// A set of processors with numbers less than `most`, empty at first.
class ProcessorSet {
 public:
  explicit ProcessorSet(std::size_t most) : set_(CPU_ALLOC(most)), size_(CPU_ALLOC_SIZE(most)) {
    CPU_ZERO_S(size_, set_.get());
  }

  cpu_set_t* get() const { return set_.get(); }
  std::size_t size() const { return size_; }
  void add(unsigned processor) { CPU_SET_S(processor, size_, get()); }
  bool has(unsigned processor) const { return CPU_ISSET_S(processor, size_, get()); }

 private:
  struct Free {
    void operator()(cpu_set_t* set) const { CPU_FREE(set); }
  };

  std::unique_ptr<cpu_set_t, Free> set_;
  std::size_t size_;
};

}  // namespace

// The system refuses a set that is too small for its processors, so this tries larger ones.
std::vector<unsigned> allowed_processors() {
  std::vector<unsigned> processors;
  for (std::size_t most = CPU_SETSIZE; processors.empty() && most <= 1 << 20; most *= 2) {
    const ProcessorSet set(most);
    if (::sched_getaffinity(0, set.size(), set.get()) != 0) continue;
    for (unsigned number = 0; number < most; ++number)
      if (set.has(number)) processors.push_back(number);
  }
  return processors;
}

void bind_to(std::jthread& thread, unsigned processor) {
  ProcessorSet set(processor + 1);
  set.add(processor);
  if (const int error = ::pthread_setaffinity_np(thread.native_handle(), set.size(), set.get()); error != 0)
    throw InvalidInput("a thread could not be bound to processor " + std::to_string(processor) + ": " +
                       std::generic_category().message(error));
}

}  // namespace racebeam
