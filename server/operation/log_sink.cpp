#include "server/operation/log_sink.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <new>
#include <thread>
#include <utility>

namespace racebeam {
namespace {

using namespace std::chrono_literals;

constexpr auto kLastMoment = 200ms;

// Writes a line, and may block for ever. Bytes that cannot be written, as on a full disk, are dropped.
void write_whole(int descriptor, std::string_view line) {
  while (!line.empty()) {
    const std::ptrdiff_t count = write_some(descriptor, OutputKind::kFile, line);
    if (count < 0 && errno != EINTR) return;
    if (count > 0) line.remove_prefix(static_cast<std::size_t>(count));
  }
}

}  // namespace

// The thread shares the sink, and may outlive its owner: it can hang in a write for ever.
std::shared_ptr<LogSink> LogSink::start(int descriptor, OutputKind kind,
                                        std::function<std::string(std::int64_t)> loss_text) {
  std::shared_ptr<LogSink> sink(new LogSink(descriptor, kind, std::move(loss_text)));
  if (kind == OutputKind::kFile) std::thread([sink] { sink->write_file(); }).detach();
  return sink;
}

LogSink::LogSink(int descriptor, OutputKind kind, std::function<std::string(std::int64_t)> loss_text)
    : descriptor_(descriptor), kind_(kind), loss_text_(std::move(loss_text)) {}

void LogSink::close() {
  const auto end = std::chrono::steady_clock::now() + kLastMoment;
  std::unique_lock lock(mutex_);
  const auto all_written = [this] {
    flush_();
    return waiting_.empty() && !writing_;
  };
  while (!all_written() && std::chrono::steady_clock::now() < end) changed_.wait_for(lock, 5ms);
  closed_ = true;
  changed_.notify_all();
}

void LogSink::sink_it_(const spdlog::details::log_msg& message) {
  if (waiting_.size() >= kMaxWaiting) lose_oldest();
  add(message);
}

void LogSink::add(const spdlog::details::log_msg& message) {
  spdlog::memory_buf_t text;
  formatter_->format(message, text);
  waiting_.emplace_back(text.data(), text.size());
}

void LogSink::lose_oldest() {
  waiting_.erase(waiting_.begin() + (has_begun_ ? 1 : 0));
  ++unreported_;
  ++lost_;
}

// Reports lost lines at their place, before the remaining ones. Without memory for that, it does so later.
void LogSink::report_lost() {
  try {
    const std::string sentence = loss_text_(unreported_);
    add({{}, "racebeam", spdlog::level::warn, sentence});
  } catch (const std::bad_alloc&) {
    return;
  }
  unreported_ = 0;
  std::rotate(waiting_.begin() + (has_begun_ ? 1 : 0), waiting_.end() - 1, waiting_.end());
}

void LogSink::flush_() {
  if (kind_ == OutputKind::kFile) return changed_.notify_all();
  while (!waiting_.empty() && has_room(descriptor_)) {
    if (unreported_ > 0) report_lost();
    if (!write(waiting_.front())) return;
    waiting_.pop_front();
  }
}

void LogSink::write_file() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return closed_ || !waiting_.empty(); });
    if (closed_) return;
    if (unreported_ > 0) report_lost();
    const std::string line = std::move(waiting_.front());
    waiting_.pop_front();
    writing_ = true;
    lock.unlock();
    write_whole(descriptor_, line);
    lock.lock();
    writing_ = false;
    changed_.notify_all();
  }
}

// Bytes that cannot be written, because the reader is gone, are dropped.
bool LogSink::write(std::string& line) {
  const std::ptrdiff_t count = write_some(descriptor_, kind_, line);
  if (count < 0) return !may_be_repeated(errno);
  has_begun_ = static_cast<std::size_t>(count) < line.size();
  if (has_begun_) line.erase(0, static_cast<std::size_t>(count));
  return !has_begun_;
}

}  // namespace racebeam
