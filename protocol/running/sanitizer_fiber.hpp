// Announces stack switches to AddressSanitizer and ThreadSanitizer, which cannot detect them. Without
// sanitizers it is empty.
#pragma once

#include <cstddef>

#if defined(__SANITIZE_ADDRESS__)
#define RACEBEAM_ASAN 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define RACEBEAM_ASAN 1
#endif
#endif
#if defined(__SANITIZE_THREAD__)
#define RACEBEAM_TSAN 1
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define RACEBEAM_TSAN 1
#endif
#endif

#if defined(RACEBEAM_ASAN)
#include <sanitizer/common_interface_defs.h>
#endif
#if defined(RACEBEAM_TSAN)
#include <sanitizer/tsan_interface.h>
#endif

namespace racebeam {

// Each switch is announced on the old stack, and confirmed on the new one.
class SanitizerFiber {
 public:
#if defined(RACEBEAM_ASAN)
  SanitizerFiber(void* bottom, std::size_t size) : bottom_(bottom), size_(size) {}
  void leaves_caller() { __sanitizer_start_switch_fiber(&caller_, bottom_, size_); }
  void arrived_in_body() { __sanitizer_finish_switch_fiber(body_, &caller_bottom_, &caller_size_); }
  void leaves_body() { __sanitizer_start_switch_fiber(&body_, caller_bottom_, caller_size_); }
  void leaves_body_for_good() { __sanitizer_start_switch_fiber(nullptr, caller_bottom_, caller_size_); }
  void arrived_in_caller() { __sanitizer_finish_switch_fiber(caller_, nullptr, nullptr); }

 private:
  void* bottom_;
  std::size_t size_;
  void *caller_ = nullptr, *body_ = nullptr;  // their stacks of locals that outlive a return
  const void* caller_bottom_ = nullptr;
  std::size_t caller_size_ = 0;
#elif defined(RACEBEAM_TSAN)
  SanitizerFiber(void*, std::size_t) : body_(__tsan_create_fiber(0)) {}
  ~SanitizerFiber() { __tsan_destroy_fiber(body_); }
  SanitizerFiber(const SanitizerFiber&) = delete;
  SanitizerFiber& operator=(const SanitizerFiber&) = delete;
  void leaves_caller() {
    caller_ = __tsan_get_current_fiber();
    __tsan_switch_to_fiber(body_, 0);
  }
  void arrived_in_body() {}
  void leaves_body() { __tsan_switch_to_fiber(caller_, 0); }
  void leaves_body_for_good() { leaves_body(); }
  void arrived_in_caller() {}

 private:
  void *body_, *caller_ = nullptr;
#else
  SanitizerFiber(void*, std::size_t) {}
  void leaves_caller() {}
  void arrived_in_body() {}
  void leaves_body() {}
  void leaves_body_for_good() {}
  void arrived_in_caller() {}
#endif
};

}  // namespace racebeam
