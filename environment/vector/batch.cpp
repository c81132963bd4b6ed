#include "environment/vector/batch.hpp"

#include <algorithm>
#include <cmath>
#include <concepts>
#include <condition_variable>
#include <mutex>
#include <numeric>
#include <string>
#include <system_error>
#include <utility>

#include "emulator/base/large_pages.hpp"
#include "environment/vector/thread_pool.hpp"
#include "games/game/actions.hpp"
#include "system/invalid_input.hpp"
#include "system/resources.hpp"

namespace racebeam {
namespace {

// `sentence` is a function, so that a step without an error allocates no text.
template <class Sentence>
void refuse_unless(bool good, const Sentence& sentence) {
  if (!good) throw InvalidInput(sentence());
}

std::string count_of(std::uint64_t count, const std::string& what) {
  return std::to_string(count) + ' ' + what;
}

std::string machines_of(std::size_t count, std::string_view noun) {
  return count_of(count, std::string(noun) + "s");
}

void check_act(const Act& act, const Slot& slot) {
  refuse_unless(slot.environment().accepts({.a = act.a}), [&] {
    return "action " + std::to_string(act.a) +
           " of player A is out of range; accepted: 0 to 25, and those of its controller";
  });
  refuse_unless(slot.environment().accepts({.b = act.b}), [&] {
    return "action " + std::to_string(act.b) +
           " of player B is out of range; accepted: 18 to 35, and those of its controller";
  });
  for (const float strength : {act.strength_a, act.strength_b}) {
    refuse_unless(std::isfinite(strength), [&] {
      return "the strength of a paddle is " + std::to_string(strength) + "; it must be a finite number";
    });
  }
}

// Bytes of a machine that has played, without its stack and results; measured (docs/performance.md).
constexpr std::uint64_t kMachine = 240U << 10U;

// More threads than machines would have nothing to do.
unsigned useful_threads(unsigned requested, std::size_t machines) {
  const std::uint64_t threads = requested != 0 ? requested : usable_processors().amount;
  return static_cast<unsigned>(std::min({threads, std::uint64_t{machines}, std::uint64_t{kMaxWorkers}}));
}

// Returns the batch size.
std::size_t checked_size(std::size_t machines, const BatchSettings& settings) {
  refuse_unless(machines > 0, [&] {
    return "there are " + machines_of(machines, settings.noun) + "; there must be 1 or more";
  });
  refuse_unless(settings.batch_size <= machines, [&] {
    return "batch_size is " + std::to_string(settings.batch_size) + "; it takes 1 to " +
           std::to_string(machines) + ", or 0 for all";
  });
  const StackSettings& stack = settings.stack;
  refuse_unless(stack.depth >= 0, [&] {
    return "the stack has " + std::to_string(stack.depth) + " screens; it must have 0 or more";
  });
  check_memory(machines, settings.noun);
  return settings.batch_size == 0 ? machines : settings.batch_size;
}

}  // namespace

// Before anything is allocated, since a system that overcommits memory kills the process only later.
void check_memory(std::size_t machines, std::string_view noun) {
  const std::uint64_t bytes = machines * kMachine, all = usable_memory().amount;
  refuse_unless(bytes <= all, [&] {
    return machines_of(machines, noun) + " take about " +
           count_of(bytes >> 20, "MiB; this process may use ") + count_of(all >> 20, "MiB");
  });
}

struct Batch::Impl final : VectorHost {
  Impl(std::span<const Cartridge> cartridges, const BatchSettings& batch_settings, InterruptCheck check)
      : settings(batch_settings),
        interrupt_check(check),
        batch_size(checked_size(cartridges.size(), batch_settings)),
        large_pages(cartridges.size()),
        pool(useful_threads(batch_settings.threads, cartridges.size()), batch_settings.busy_poll,
             batch_settings.first_processor),
        layout(batch_settings.stack, batch_settings.screens,
               batch_settings.autoreset == Autoreset::kSameStep),
        finals(cartridges.size()),
        vector(cartridges, batch_settings.slot, batch_settings.autoreset, *this),
        playing(vector.size()),
        jobs(vector.size()),
        queue(pool, [this](std::size_t number) { play(number); }) {
    int height = 0;
    for (std::size_t number = 0; number < vector.size(); ++number)
      height = std::max(height, vector.slot(number).environment().height());
    layout.set_height(height);
    done.reserve(vector.size());
  }

  // VectorHost
  void run_all(std::size_t count, const std::function<void(std::size_t)>& task) override {
    InterruptPoll interrupt_poll(interrupt_check);
    pool.run(count, [&](std::size_t number) {
      if (interrupt_poll.may_continue()) task(number);
    });
    interrupt_poll.rethrow();
  }
  void opened(std::size_t, Slot& slot) override {
    slot.set_drawing(settings.screens ? Drawing::kLast : Drawing::kNone);
    slot.set_stack(settings.stack);
  }
  void ended(std::size_t number, const Slot& slot) override {
    if (out != nullptr) return layout.write_final(slot, number, *out);
    finals[number].keep(layout, slot);
  }
  void show(std::size_t number, const Slot& slot) override {
    if (out != nullptr) layout.write(slot, number, number, *out);
  }

  std::span<const Act> acts_of(std::span<const int> actions, auto machine_of);
  void check_count(std::size_t count, const std::string& what, std::size_t machines) const;
  std::string name_of(std::integral auto machine) const {
    return std::string(settings.noun) + ' ' + std::to_string(machine);
  }
  void check_free() const;
  void check_free(std::size_t machine) const;
  void check_machines(std::span<const std::int32_t> machines) const;
  void begin(std::span<const std::int32_t> machines);
  void play(std::size_t number);
  std::size_t busy() const;
  std::span<const std::size_t> await(std::size_t count);
  void settle(std::span<const std::size_t> numbers, auto which);
  void throw_failure_of(std::span<const std::size_t> numbers);

  struct Job {
    Act act;
    bool resets = false;
    std::int64_t seed = -1;
    std::uint64_t place = 0;  // among all that were sent
    bool failed = false;
  };

  // Directs results into `arrays` for as long as it lives.
  struct Output {
    Output(Impl& of, const BatchArrays& arrays) : impl(of) { impl.out = &arrays; }
    ~Output() { impl.out = nullptr; }
    Impl& impl;
  };

  const BatchSettings settings;
  InterruptCheck interrupt_check;
  const std::size_t batch_size;
  const LargePageScope large_pages;
  ThreadPool pool;
  const BatchArrays* out = nullptr;  // of the request that runs; null between send() and receive()
  ResultLayout layout;
  std::vector<FinalResult> finals;  // by machine, from the episode's end to receive()
  VectorEnvironment vector;

  std::vector<Act> acts;              // of a request; a member to reuse its memory
  std::vector<std::uint8_t> playing;  // by machine: from send() to receive()
  std::vector<Job> jobs;
  std::uint64_t sent = 0;
  std::vector<std::size_t> received;
  std::mutex mutex;
  std::condition_variable one_is_done;
  std::vector<std::size_t> done;    // under the mutex
  std::exception_ptr last_failure;  // of a job, under the mutex; one is kept, as in FirstFailure
  ThreadPool::Queue queue;          // the last member, so that it is destroyed first
};

std::span<const Act> Batch::Impl::acts_of(std::span<const int> actions, auto machine_of) {
  acts.clear();
  for (std::size_t i = 0; i < actions.size(); ++i) {
    const std::size_t machine = machine_of(i);
    const std::vector<int>& all = vector.slot(machine).actions();
    refuse_unless(actions[i] >= 0 && static_cast<std::size_t>(actions[i]) < all.size(), [&] {
      return name_of(machine) + " has no action " + std::to_string(actions[i]) + "; it takes 0 to " +
             std::to_string(all.size() - 1);
    });
    acts.push_back({.a = all[static_cast<std::size_t>(actions[i])]});
  }
  return acts;
}

void Batch::Impl::check_count(std::size_t count, const std::string& what, std::size_t machines) const {
  refuse_unless(count == machines, [&] {
    return "there are " + count_of(count, what) + " for " + machines_of(machines, settings.noun);
  });
}

void Batch::Impl::check_free() const {
  refuse_unless(busy() == 0,
                [&] { return machines_of(busy(), settings.noun) + " play; receive them first"; });
}

void Batch::Impl::check_free(std::size_t machine) const {
  refuse_unless(playing[machine] == 0, [&] { return name_of(machine) + " plays; receive it first"; });
}

void Batch::Impl::check_machines(std::span<const std::int32_t> machines) const {
  std::vector<std::uint8_t> taken_machines = playing;
  for (const std::int32_t machine : machines) {
    const bool is_there = machine >= 0 && static_cast<std::size_t>(machine) < taken_machines.size();
    refuse_unless(is_there, [&] {
      return name_of(machine) + " is out of range; accepted: 0 to " +
             std::to_string(taken_machines.size() - 1);
    });
    refuse_unless(std::exchange(taken_machines[static_cast<std::size_t>(machine)], std::uint8_t{1}) == 0,
                  [&] { return name_of(machine) + " plays already; receive it first"; });
  }
}

void Batch::Impl::begin(std::span<const std::int32_t> machines) {
  const std::vector<std::size_t> numbers(machines.begin(), machines.end());
  for (const std::size_t number : numbers) {
    playing[number] = 1;
    jobs[number].place = sent++;
  }
  queue.push(numbers);
}

std::size_t Batch::Impl::busy() const { return static_cast<std::size_t>(std::ranges::count(playing, 1)); }

// Runs on any thread.
void Batch::Impl::play(std::size_t number) {
  Job& job = jobs[number];
  try {
    job.resets ? vector.reset_one(number, job.seed) : vector.step_one(number, job.act);
  } catch (const std::exception&) {
    job.failed = true;
    const std::lock_guard lock(mutex);
    last_failure = std::current_exception();
  }
  {
    const std::lock_guard lock(mutex);
    done.push_back(number);
  }
  one_is_done.notify_one();
}

// The machines that have finished first; settle() takes them away. Meanwhile the caller's thread runs
// machines, too.
std::span<const std::size_t> Batch::Impl::await(std::size_t count) {
  refuse_unless(busy() >= count, [&] {
    return machines_of(busy(), settings.noun) + " play, and a receive takes " + std::to_string(count) +
           "; send some first";
  });
  const auto enough = [&] { return done.size() >= count; };
  InterruptPoll interrupt_poll(interrupt_check);
  std::unique_lock lock(mutex);
  while (!enough()) {
    lock.unlock();
    interrupt_poll.poll();
    const bool worked = queue.work_once();
    lock.lock();
    if (!worked) one_is_done.wait_for(lock, InterruptPoll::kInterval, enough);
  }
  received.assign(done.begin(), done.begin() + static_cast<std::ptrdiff_t>(count));
  if (batch_size == vector.size())
    std::ranges::sort(received, {}, [this](std::size_t number) { return jobs[number].place; });
  return received;
}

// Marks the machines for which which(number) is true as received.
void Batch::Impl::settle(std::span<const std::size_t> numbers, auto which) {
  for (const std::size_t number : numbers)
    if (which(number)) playing[number] = 0;
  const std::lock_guard lock(mutex);
  std::erase_if(done, [this](std::size_t number) { return playing[number] == 0; });
}

void Batch::Impl::throw_failure_of(std::span<const std::size_t> numbers) {
  const auto has_failed = [this](std::size_t number) { return jobs[number].failed; };
  if (std::ranges::none_of(numbers, has_failed)) return;
  settle(numbers, has_failed);
  const std::exception_ptr failure = [this] {
    const std::lock_guard lock(mutex);
    return last_failure;
  }();
  std::rethrow_exception(failure);
}

Batch::Batch(std::span<const Cartridge> cartridges, const BatchSettings& settings,
             InterruptCheck interrupt_check) try
    : impl_(std::make_unique<Impl>(cartridges, settings, interrupt_check)) {
} catch (const std::system_error& error) {  // of the pool
  throw InvalidInput(std::string(error.what()) + "; ask for fewer");
}

Batch::~Batch() = default;
Batch::Batch(Batch&&) noexcept = default;
Batch& Batch::operator=(Batch&&) noexcept = default;

std::size_t Batch::size() const { return impl_->vector.size(); }
std::size_t Batch::batch_size() const { return impl_->batch_size; }
int Batch::height() const { return impl_->layout.height(); }
std::size_t Batch::observation_size() const { return impl_->layout.observation_size(); }
std::size_t Batch::audio_size() const { return racebeam::audio_size(impl_->settings.slot); }
unsigned Batch::threads() const { return impl_->pool.threads(); }
Slot& Batch::slot(std::size_t machine) {
  impl_->check_free(machine);
  return impl_->vector.slot(machine);
}
const std::vector<int>& Batch::actions(std::size_t machine) const {
  return impl_->vector.slot(machine).actions();
}

void Batch::set_interrupt_check(InterruptCheck interrupt_check) { impl_->interrupt_check = interrupt_check; }

BatchResults Batch::make_results() const { return impl_->layout.make_results(batch_size()); }

void Batch::step(std::span<const Act> acts, const BatchArrays& out) {
  impl_->check_count(acts.size(), "actions", size());
  for (std::size_t i = 0; i < acts.size(); ++i) check_act(acts[i], impl_->vector.slot(i));
  impl_->check_free();
  const Impl::Output output(*impl_, out);
  impl_->vector.step(acts);
}

void Batch::step(std::span<const int> actions, const BatchArrays& out) {
  impl_->check_count(actions.size(), "actions", size());
  step(impl_->acts_of(actions, [](std::size_t i) { return i; }), out);
}

void Batch::reset(const BatchArrays& out, std::span<const std::uint8_t> mask,
                  std::span<const std::int64_t> seeds) {
  if (!mask.empty()) impl_->check_count(mask.size(), "choices", size());
  if (!seeds.empty()) impl_->check_count(seeds.size(), "seeds", size());
  impl_->check_free();
  const Impl::Output output(*impl_, out);
  impl_->vector.reset(mask, seeds);
}

void Batch::show(const BatchArrays& out) const {
  impl_->check_free();
  for (std::size_t number = 0; number < size(); ++number)
    impl_->layout.write(impl_->vector.slot(number), number, number, out);
}

void Batch::end_episodes(std::span<const std::int32_t> machines, std::span<const std::int64_t> seeds) {
  if (!seeds.empty()) impl_->check_count(seeds.size(), "seeds", machines.size());
  impl_->check_machines(machines);
  for (std::size_t i = 0; i < machines.size(); ++i) {
    Slot& slot = impl_->vector.slot(static_cast<std::size_t>(machines[i]));
    slot.end_episode(seed_of(seeds.empty() ? -1 : seeds[i]));
  }
}

void Batch::send(std::span<const Act> acts, std::span<const std::int32_t> machines) {
  impl_->check_count(acts.size(), "actions", machines.size());
  impl_->check_machines(machines);
  for (std::size_t i = 0; i < acts.size(); ++i)
    check_act(acts[i], impl_->vector.slot(static_cast<std::size_t>(machines[i])));
  for (std::size_t i = 0; i < machines.size(); ++i)
    impl_->jobs[static_cast<std::size_t>(machines[i])] = {.act = acts[i]};
  impl_->begin(machines);
}

void Batch::send(std::span<const int> actions, std::span<const std::int32_t> machines) {
  impl_->check_count(actions.size(), "actions", machines.size());
  impl_->check_machines(machines);
  send(impl_->acts_of(actions, [&](std::size_t i) { return static_cast<std::size_t>(machines[i]); }),
       machines);
}

void Batch::send_resets(std::span<const std::int64_t> seeds) {
  if (!seeds.empty()) impl_->check_count(seeds.size(), "seeds", size());
  impl_->check_free();
  std::vector<std::int32_t> all(size());
  std::iota(all.begin(), all.end(), 0);
  for (std::size_t number = 0; number < size(); ++number)
    impl_->jobs[number] = {.act = {}, .resets = true, .seed = seeds.empty() ? -1 : seeds[number]};
  impl_->begin(all);
}

std::size_t Batch::playing() const { return impl_->busy(); }

void Batch::receive(const BatchArrays& out, std::size_t count) {
  const auto numbers = impl_->await(count);
  impl_->throw_failure_of(numbers);
  for (std::size_t position = 0; position < numbers.size(); ++position) {
    const std::size_t number = numbers[position];
    const Slot& slot = impl_->vector.slot(number);
    impl_->layout.write(slot, number, position, out);
    const bool ended = slot.outcome().finished && impl_->settings.autoreset == Autoreset::kSameStep;
    if (ended) impl_->finals[number].write(position, out);
  }
  impl_->settle(numbers, [](std::size_t) { return true; });
}

}  // namespace racebeam
