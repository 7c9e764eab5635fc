// Loops on a team of threads: every iteration once, whatever happens.
#include "lattice/threads/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <numeric>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

using fingertip::lattice::Team;

namespace {

/// How often each iteration of a loop was run.
std::vector<int> visits(Team& team, std::size_t count, std::size_t grain) {
  std::vector<int> result(count, 0);
  team.split(count, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) ++result[i];
  });
  return result;
}

void expect_once(Team& team, std::size_t count, std::size_t grain) {
  EXPECT_EQ(visits(team, count, grain), std::vector<int>(count, 1))
      << team.threads() << " threads, grain " << grain;
}

}  // namespace

TEST(Team, RunsEveryIterationOnce) {
  for (const int threads : {1, 2, 3, 7}) {
    Team team(threads);
    EXPECT_EQ(team.threads(), threads);
    for (const std::size_t grain : {0, 1, 3, 100}) {
      for (const std::size_t count : {0, 1, 2, 5, 29, 100, 1000}) expect_once(team, count, grain);
    }
  }
}

TEST(Team, TakesAllCoresWhenNotTold) {
  Team team(0);
  EXPECT_GE(team.threads(), 1);
  expect_once(team, 100, 1);
}

TEST(Team, GivesNoPieceBelowTheGrain) {
  Team team(3);
  std::atomic<std::size_t> smallest{1000};
  team.split(100, 30, [&](std::size_t begin, std::size_t end) {
    std::size_t seen = smallest;
    while (end - begin < seen && !smallest.compare_exchange_weak(seen, end - begin)) {
    }
  });
  EXPECT_GE(smallest.load(), 30u);
}

TEST(Team, LoopsFollowEachOther) {
  Team team(2);
  std::vector<long> values(64, 0);
  constexpr int loops = 20000;
  for (int n = 0; n < loops; ++n) {
    // Each reads what the one before wrote elsewhere.
    team.split(values.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) values[i] += 1;
    });
    if (n % 2000 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));  // they sleep
    const long sum = std::accumulate(values.begin(), values.end(), 0L);
    ASSERT_EQ(sum, long(n + 1) * 64);
  }
}

TEST(Team, ThreadsTakePart) {
  Team team(2);
  // Two pieces that wait for each other: one thread alone would wait in vain.
  std::atomic<int> arrived{0};
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  team.split(2, 1, [&](std::size_t, std::size_t) {
    ++arrived;
    while (arrived < 2 && std::chrono::steady_clock::now() < deadline) std::this_thread::yield();
  });
  EXPECT_LT(std::chrono::steady_clock::now(), deadline);
}

TEST(Team, ALoopWithinALoopRunsInItsThread) {
  Team team(2);
  std::vector<int> sums(100, 0);
  team.split(sums.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto self = std::this_thread::get_id();
      team.split(50, 1, [&](std::size_t from, std::size_t to) {
        EXPECT_EQ(std::this_thread::get_id(), self);
        sums[i] += int(to - from);
      });
    }
  });
  EXPECT_EQ(sums, std::vector<int>(100, 50));
}

TEST(Team, SeveralTeamsAndCallersAtOnce) {
  Team shared(2);
  std::vector<std::thread> callers;
  for (int caller = 0; caller < 3; ++caller) {
    callers.emplace_back([&] {
      Team own(3);
      for (int n = 0; n < 300; ++n) {
        expect_once(shared, 40, 1);
        expect_once(own, 40, 1);
      }
    });
  }
  for (std::thread& caller : callers) caller.join();
}

TEST(Team, ThrowsWhatTheFirstPieceThrew) {
  for (const int threads : {1, 2, 5}) {
    Team team(threads);
    for (int n = 0; n < 200; ++n) {
      std::vector<int> seen(100, 0);
      try {
        team.split(seen.size(), 1, [&](std::size_t begin, std::size_t end) {
          for (std::size_t i = begin; i < end; ++i) {
            ++seen[i];
            if (i == 3 || i == 97) throw std::runtime_error(std::to_string(i));
          }
        });
        FAIL() << "nothing was thrown";
      } catch (const std::runtime_error& error) {
        EXPECT_STREQ(error.what(), "3");
      }
      expect_once(team, 100, 1);  // and it goes on
    }
  }
}

TEST(Team, CopiesShareTheThreads) {
  Team copy(1);
  {
    const Team team(2);
    copy = team;
  }
  EXPECT_EQ(copy.threads(), 2);
  expect_once(copy, 100, 1);
  Team other = copy;
  copy.split(100, 1, [&](std::size_t, std::size_t) {
    const auto self = std::this_thread::get_id();
    other.split(100, 1,
                [&](std::size_t, std::size_t) { EXPECT_EQ(std::this_thread::get_id(), self); });
  });
}
