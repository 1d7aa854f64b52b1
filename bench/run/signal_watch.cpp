// SPDX-License-Identifier: Apache-2.0
#include "bench/run/signal_watch.hpp"

#include <unistd.h>

#include <csignal>
#include <cstring>

namespace mh {
namespace {

volatile std::sig_atomic_t g_signal = 0;
volatile std::sig_atomic_t g_goes_on = 0;

/// Calls only functions that are safe in a signal handler.
void end_at_once(int) {
  const char* line = interrupted_line(g_goes_on != 0);
  [[maybe_unused]] const auto written = write(STDERR_FILENO, line, std::strlen(line));
  _exit(kInterruptedCode);
}

}  // namespace

const char* interrupted_line(bool goes_on) {
  return goes_on ? "modelhouse: interrupted; finished results are kept; the same command resumes\n"
                 : "modelhouse: interrupted; nothing is kept; the same command starts over\n";
}

void tell_of_interrupts() {
  for (const int number : {SIGINT, SIGTERM}) std::signal(number, end_at_once);
  // Under nohup, SIGHUP is ignored and must remain ignored.
  if (std::signal(SIGHUP, end_at_once) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
}

void interrupts_go_on() {
  g_goes_on = 1;
}

SignalWatch::SignalWatch() : old_int_{}, old_term_{}, old_hangup_{} {
  g_signal = 0;
  struct sigaction action {};
  action.sa_handler = [](int number) { g_signal = number; };
  sigaction(SIGINT, &action, &old_int_);
  sigaction(SIGTERM, &action, &old_term_);
  sigaction(SIGHUP, &action, &old_hangup_);
  if (old_hangup_.sa_handler == SIG_IGN) sigaction(SIGHUP, &old_hangup_, nullptr);
}

SignalWatch::~SignalWatch() {
  sigaction(SIGINT, &old_int_, nullptr);
  sigaction(SIGTERM, &old_term_, nullptr);
  sigaction(SIGHUP, &old_hangup_, nullptr);
}

int SignalWatch::signal() const {
  return static_cast<int>(g_signal);
}

}  // namespace mh
