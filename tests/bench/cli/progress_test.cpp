// SPDX-License-Identifier: Apache-2.0
#include "bench/cli/progress.hpp"

#include <fcntl.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <optional>
#include <thread>

#include <gtest/gtest.h>

namespace mh::cli {
namespace {

TEST(BarLine, StaysWithinTheColumnsAndGivesWayFromTheEnd) {
  const std::string figures = "123 tracked, 45 keyframes, 6789 landmarks, 31.2 ms a frame";
  for (std::size_t columns = 1; columns < 160; ++columns)
    EXPECT_LE(bar_line("slam", 0.5, ", 3 min 20 s to go", figures, columns).size(), columns);
  const std::string wide = bar_line("slam", 0.5, ", 3 s to go", figures, 160);
  EXPECT_NE(wide.find(figures), std::string::npos);
  EXPECT_NE(wide.find(std::string(20, '#') + std::string(20, '.')), std::string::npos);
  const std::string usual = bar_line("slam", 0.5, ", 3 s to go", figures, 79);
  EXPECT_NE(usual.find("; 123 tracked, 45 keyframes"), std::string::npos) << usual;
  EXPECT_EQ(usual.find("ms a frame"), std::string::npos) << usual;
}

TEST(Progress, OffATerminalIsALineEveryTenthWhateverTheFigures) {
  std::FILE* file = std::tmpfile();
  ASSERT_NE(file, nullptr);
  {
    Progress progress("slam", file);
    for (int i = 1; i <= 1000; ++i) progress.share(i / 1000.0, std::to_string(i) + " tracked");
  }
  std::string text(static_cast<std::size_t>(std::ftell(file)), '\0');
  std::rewind(file);
  ASSERT_EQ(std::fread(text.data(), 1, text.size(), file), text.size());
  std::fclose(file);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 11)
      << text;  // one at the start and one for each tenth
  EXPECT_NE(text.find("slam: 30 %"), std::string::npos) << text;
  EXPECT_NE(text.find("slam: 100 %; 1000 tracked\n"), std::string::npos) << text;
}

TEST(Progress, PreparationsDoNotMakeTheTimeToGoLonger) {
  std::FILE* file = std::tmpfile();
  ASSERT_NE(file, nullptr);
  {
    Progress progress("bench", file);
    progress.share(0);
    std::this_thread::sleep_for(std::chrono::milliseconds(1200));  // such as baking light
    progress.share(0.101);
    progress.share(0.501);  // right after it: at this rate, the rest takes less than a second
    progress.share(0.6, "", 95);
    progress.share(0.7, "", std::nullopt);
  }
  std::string text(static_cast<std::size_t>(std::ftell(file)), '\0');
  std::rewind(file);
  ASSERT_EQ(std::fread(text.data(), 1, text.size(), file), text.size());
  std::fclose(file);
  EXPECT_EQ(text,
            "bench: 0 %\nbench: 10 %\nbench: 50 %, 0 s to go\nbench: 60 %, 1 min 35 s to go\n"
            "bench: 70 %\n");
}

TEST(Progress, OnATerminalClearsTheLineKeepsToItsWidthAndEndsIt) {
  const int terminal = posix_openpt(O_RDWR | O_NOCTTY);
  if (terminal < 0 || grantpt(terminal) != 0 || unlockpt(terminal) != 0) GTEST_SKIP();
  const int side = open(ptsname(terminal), O_RDWR | O_NOCTTY);
  ASSERT_GE(side, 0);
  winsize size{};
  size.ws_col = 50;
  ASSERT_EQ(ioctl(side, TIOCSWINSZ, &size), 0);
  termios raw{};
  tcgetattr(side, &raw);
  cfmakeraw(&raw);
  tcsetattr(side, TCSANOW, &raw);
  std::FILE* file = fdopen(side, "w");
  std::string text;
  {
    Progress progress("slam", file);
    progress.share(0.1, "a long figure, another long figure, and one more");
    progress.share(0.5, "short");
    progress.end();
  }
  std::fclose(file);
  // Reads from a terminal return the output in pieces, and fail once the other side is closed.
  std::array<char, 256> piece{};
  for (ssize_t count; (count = read(terminal, piece.data(), piece.size())) > 0;)
    text.append(piece.data(), static_cast<std::size_t>(count));
  close(terminal);
  ASSERT_FALSE(text.empty());
  EXPECT_EQ(text.back(), '\n') << "a report must not be glued to the bar";
  for (std::size_t at = text.find('\r'); at != std::string::npos;) {
    const std::size_t clear = text.find("\x1b[K", at);
    ASSERT_NE(clear, std::string::npos) << "what was there before would show behind";
    EXPECT_LT(clear - at - 1, 50u);
    at = text.find('\r', clear);
  }
  EXPECT_NE(text.find("; short"), std::string::npos);
}

}  // namespace
}  // namespace mh::cli
