#include "tools/progress_bar.h"

#include <cstdio>

#include <unistd.h>

namespace gpu_planning_scene::core
{
using std::chrono::milliseconds;
using std::chrono::steady_clock;

ProgressBar::ProgressBar(std::string label, std::size_t total)
  : label_(std::move(label)),
    total_(total),
    terminal_(isatty(STDERR_FILENO) != 0),
    next_(steady_clock::now() + milliseconds(1000))
{
}

ProgressBar::~ProgressBar()
{
  if (drawn_)
    std::fputs("\r\033[K", stderr);
}

void ProgressBar::update(std::size_t done)
{
  const auto now = steady_clock::now();
  if (!terminal_ || total_ == 0 || now < next_)
    return;
  next_ = now + milliseconds(100);
  drawn_ = true;
  constexpr std::size_t kWidth = 40;
  const std::string bar(kWidth * done / total_, '#');
  std::fprintf(stderr, "\r\033[K%s [%-*s] %zu/%zu", label_.c_str(), static_cast<int>(kWidth), bar.c_str(), done,
               total_);
  std::fflush(stderr);
}
}  // namespace gpu_planning_scene::core
