// Coroutines of the server. Asio's own, awaitable<>, do not survive an operation that cannot start for lack
// of memory or file descriptors: they run on without an owner. A Task receives that as an exception.
//
// A Task begins when it is awaited, or by spawn(). It owns its frame, and the frame owns what it awaits.
#pragma once

#include <coroutine>
#include <exception>
#include <optional>
#include <tuple>
#include <type_traits>
#include <utility>

#include <boost/asio/async_result.hpp>
#include <boost/asio/error.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <boost/system/system_error.hpp>

namespace racebeam {

template <typename T = void>
class Task;

// Logs an exception that ends a spawned task.
void report_failure(const std::exception_ptr& failure) noexcept;

// The common part of the frames of all tasks.
class TaskFrame {
 public:
  std::suspend_always initial_suspend() const noexcept { return {}; }
  auto final_suspend() const noexcept { return Final{}; }
  void unhandled_exception() noexcept { failure_ = std::current_exception(); }

  void resume() const { self_.resume(); }
  void destroy_all() const noexcept;  // destroys this frame, and those that await it

 protected:
  struct Final {
    bool await_ready() const noexcept { return false; }
    template <typename Frame>
    std::coroutine_handle<> await_suspend(std::coroutine_handle<Frame> done) const noexcept {
      if (const TaskFrame* const caller = done.promise().caller_) return caller->self_;
      if (done.promise().failure_) report_failure(done.promise().failure_);
      done.destroy();
      return std::noop_coroutine();
    }
    void await_resume() const noexcept {}
  };

  template <typename>
  friend class Task;

  std::coroutine_handle<> self_;
  const TaskFrame* caller_ = nullptr;  // null: it was spawned
  std::exception_ptr failure_;
};

template <typename T>
class TaskResult : public TaskFrame {
 public:
  template <typename U>
  void return_value(U&& value) {
    value_.emplace(std::forward<U>(value));
  }
  T take() { return std::move(*value_); }

 private:
  std::optional<T> value_;
};

template <>
class TaskResult<void> : public TaskFrame {
 public:
  void return_void() const noexcept {}
  void take() const noexcept {}
};

template <typename T>
class [[nodiscard]] Task {
 public:
  // NOLINTNEXTLINE(readability-identifier-naming): the language has this name.
  struct promise_type : TaskResult<T> {
    Task get_return_object() noexcept { return Task(*this); }
  };

  Task(Task&& other) noexcept : frame_(std::exchange(other.frame_, nullptr)) {}
  Task& operator=(Task&&) = delete;
  ~Task() {
    if (frame_ != nullptr) frame_->self_.destroy();
  }

  void start() && { std::exchange(frame_, nullptr)->resume(); }  // owned by nobody from now on

  bool await_ready() const noexcept { return false; }
  template <typename Frame>
  std::coroutine_handle<> await_suspend(std::coroutine_handle<Frame> caller) noexcept {
    frame_->caller_ = &caller.promise();
    return frame_->self_;
  }
  T await_resume() {
    if (frame_->failure_) std::rethrow_exception(frame_->failure_);
    return frame_->take();
  }

 private:
  explicit Task(promise_type& frame) noexcept : frame_(&frame) {
    frame.self_ = std::coroutine_handle<promise_type>::from_promise(frame);
  }

  promise_type* frame_;
};

// Runs the task on the thread of the loop. Throws std::bad_alloc; the task has not begun then.
inline void spawn(boost::asio::io_context& loop, Task<> task) {
  boost::asio::post(loop, [task = std::move(task)]() mutable { std::move(task).start(); });
}

// An operation of Asio that a task awaits.
class Operation {
 public:
  Operation() = default;
  Operation(const Operation&) = delete;
  Operation& operator=(const Operation&) = delete;

  // Its handler was destroyed without a call: the operation failed to begin, or an exception ended it later,
  // or its loop is being destroyed.
  void abandoned() noexcept;
  // After an exception has left a handler of the loop of this thread: passes it to the tasks whose operations
  // it has ended.
  static void fail_abandoned(const std::exception_ptr& failure) noexcept;

 protected:
  template <typename Begin>
  bool begin(const TaskFrame& task, Begin begin) noexcept {
    task_ = &task;
    try {
      begin();
    } catch (...) {
      failure_ = std::current_exception();
    }
    has_begun_ = true;
    return !done_ && !failure_;
  }
  void finish() {
    done_ = true;
    if (has_begun_) task_->resume();
  }
  void check() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  const TaskFrame* task_ = nullptr;
  bool has_begun_ = false, done_ = false;
  std::exception_ptr failure_;
  Operation* next_ = nullptr;  // of those that were abandoned
};

// The completion token: `co_await timer.async_wait(use_task)`.
struct UseTask {};
inline constexpr UseTask use_task;

template <typename Begin, typename... Results>
class OperationOf final : public Operation {
 public:
  explicit OperationOf(Begin& start) : start_(start) {}

  class Handler {
   public:
    explicit Handler(OperationOf& operation) : operation_(&operation) {}
    Handler(Handler&& other) noexcept : operation_(std::exchange(other.operation_, nullptr)) {}
    Handler& operator=(Handler&&) = delete;
    ~Handler() {
      if (operation_ != nullptr) operation_->abandoned();
    }
    void operator()(Results... results) {
      OperationOf& operation = *std::exchange(operation_, nullptr);
      operation.results_.emplace(std::move(results)...);
      operation.finish();
    }

   private:
    OperationOf* operation_;
  };

  bool await_ready() const noexcept { return false; }
  template <typename Frame>
  bool await_suspend(std::coroutine_handle<Frame> task) noexcept {
    return begin(task.promise(), [this] { start_(Handler(*this)); });
  }
  std::tuple<Results...> await_resume() {
    check();
    return std::move(*results_);
  }

 private:
  Begin& start_;
  std::optional<std::tuple<Results...>> results_;
};

// The results of an operation without its error, which is thrown.
template <typename... Values>
struct ResultsOf {
  using Type = std::tuple_element_t<0, std::tuple<Values..., void>>;
  static auto take(std::tuple<Values...> all) {
    if constexpr (sizeof...(Values) > 0) return std::get<0>(std::move(all));
  }
};
template <typename... Values>
struct ResultsOf<boost::system::error_code, Values...> {
  using Type = typename ResultsOf<Values...>::Type;
  static auto take(std::tuple<boost::system::error_code, Values...> all) {
    if (std::get<0>(all)) throw boost::system::system_error(std::get<0>(all));
    if constexpr (sizeof...(Values) > 0) return std::get<1>(std::move(all));
  }
};

}  // namespace racebeam

template <typename... Arguments>
class boost::asio::async_result<racebeam::UseTask, void(Arguments...)> {
  using Results = racebeam::ResultsOf<std::decay_t<Arguments>...>;

 public:
  using return_type = racebeam::Task<typename Results::Type>;

  template <typename Initiation, typename... More>
  static return_type initiate(Initiation initiation, racebeam::UseTask, More... more) {
    auto start = [&](auto handler) { std::move(initiation)(std::move(handler), std::move(more)...); };
    co_return Results::take(
        co_await racebeam::OperationOf<decltype(start), std::decay_t<Arguments>...>(start));
  }
};
