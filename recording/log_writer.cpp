#include "recording/log_writer.hpp"

#include <filesystem>
#include <stdexcept>
#include <utility>

namespace racebeam {

LogWriter::LogWriter(SubmissionOrder order, std::size_t most_bytes, std::unique_ptr<Claim> claim,
                     Recording::Post post, std::shared_ptr<const std::atomic<bool>> given_up)
    : name_(std::filesystem::path(order.path).filename().string()),
      post_(std::move(post)),
      order_(std::move(order)),
      budget_(most_bytes, std::move(given_up)),
      claim_(std::move(claim)) {}

void LogWriter::begin() {
  post([this] { open(); });
}

bool LogWriter::is_behind() const {
  const std::lock_guard lock(mutex_);
  return waiting_ > 0;
}

bool LogWriter::finished() const {
  const std::lock_guard lock(mutex_);
  return ended_;
}

std::optional<Recording::Cut> LogWriter::cut() const {
  const std::lock_guard lock(mutex_);
  return cut_;
}

void LogWriter::add(EpisodeLog log, std::shared_ptr<const void> charge) {
  post([this, log = std::move(log), charge = std::move(charge)] { write(log); });
}

void LogWriter::finish() {
  {
    const std::lock_guard lock(mutex_);
    if (std::exchange(finishing_, true)) return;
  }
  post([this] { close(); });
}

void LogWriter::post(std::function<void()> job) {
  {
    const std::lock_guard lock(mutex_);
    ++waiting_;
  }
  post_([self = shared_from_this(), job = std::move(job)] {
    job();
    const std::lock_guard lock(self->mutex_);
    --self->waiting_;
  });
}

void LogWriter::open() {
  try {
    if (budget_.is_given_up()) throw std::runtime_error("the server stops");
    folder_ = std::make_unique<SubmissionFolder>(std::move(order_), budget_);
    result_.bytes = budget_.taken();
  } catch (const std::exception& error) {
    result_.failure = error.what();
    close();
  }
}

void LogWriter::write(const EpisodeLog& log) {
  if (!folder_ || budget_.is_given_up()) return;
  try {
    folder_->add(log);
    ++result_.logged;
    result_.bytes = budget_.taken();
  } catch (const BudgetSpent& error) {
    cut_off(Recording::Cut::kLimit, error.what());
  } catch (const std::exception& error) {
    cut_off(Recording::Cut::kDisk, error.what());
  }
}

void LogWriter::cut_off(Recording::Cut why, const std::string& failure) {
  result_.failure = failure;
  folder_.reset();
  const std::lock_guard lock(mutex_);
  cut_ = why;
}

void LogWriter::close() {
  folder_.reset();
  claim_.reset();
  const std::lock_guard lock(mutex_);
  ended_ = true;
}

}  // namespace racebeam
