#include "server/scheduling/task.hpp"

#include "server/operation/log.hpp"

namespace racebeam {
namespace {

thread_local Operation* first_abandoned = nullptr;

}  // namespace

void report_failure(const std::exception_ptr& failure) noexcept {
  try {
    std::rethrow_exception(failure);
  } catch (const std::exception& error) {
    log(LogLevel::kError, error.what());
  } catch (...) {
    log(LogLevel::kError, "an unknown exception");
  }
}

void TaskFrame::destroy_all() const noexcept {
  const TaskFrame* bottom = this;
  while (bottom->caller_ != nullptr) bottom = bottom->caller_;
  bottom->self_.destroy();
}

void Operation::abandoned() noexcept {
  if (!has_begun_) {
    if (std::uncaught_exceptions() == 0)  // otherwise begin() catches the exception
      failure_ = std::make_exception_ptr(boost::system::system_error(boost::asio::error::operation_aborted));
  } else if (std::uncaught_exceptions() > 0) {
    next_ = std::exchange(first_abandoned, this);
  } else {
    task_->destroy_all();
  }
}

void Operation::fail_abandoned(const std::exception_ptr& failure) noexcept {
  while (first_abandoned != nullptr) {
    Operation& operation = *std::exchange(first_abandoned, first_abandoned->next_);
    operation.failure_ = failure;
    operation.task_->resume();
  }
}

}  // namespace racebeam
