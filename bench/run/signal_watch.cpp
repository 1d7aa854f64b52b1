// SPDX-License-Identifier: Apache-2.0
#include "bench/run/signal_watch.hpp"

#include <csignal>

namespace mh {
namespace {

volatile std::sig_atomic_t g_signal = 0;

}  // namespace

SignalWatch::SignalWatch() : old_int_{}, old_term_{} {
  g_signal = 0;
  struct sigaction action {};
  action.sa_handler = [](int number) { g_signal = number; };
  sigaction(SIGINT, &action, &old_int_);
  sigaction(SIGTERM, &action, &old_term_);
}

SignalWatch::~SignalWatch() {
  sigaction(SIGINT, &old_int_, nullptr);
  sigaction(SIGTERM, &old_term_, nullptr);
}

int SignalWatch::signal() const {
  return static_cast<int>(g_signal);
}

}  // namespace mh
