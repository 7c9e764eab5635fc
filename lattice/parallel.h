/// A fixed team of threads for the step loop.
#pragma once

#include <cstddef>
#include <memory>

namespace fingertip::lattice {

/// Runs loops on at most `threads` threads. The result of a loop must not depend on how its
/// iterations are distributed.
class Team {
 public:
  /// `threads` = 0 takes all cores.
  explicit Team(int threads);
  ~Team();
  Team(Team&&) noexcept;
  Team& operator=(Team&&) noexcept;

  int threads() const { return threads_; }

  /// Calls body(begin, end) for pieces that cover [0, count) once, concurrently; `grain` is the
  /// smallest piece worth handing to another thread.
  template <typename Body>
  void split(std::size_t count, std::size_t grain, const Body& body) {
    run(count, grain, {&body, [](const void* self, std::size_t begin, std::size_t end) {
                         (*static_cast<const Body*>(self))(begin, end);
                       }});
  }

 private:
  struct Arena;
  /// A borrowed callable: unlike std::function it never allocates.
  struct Borrowed {
    const void* self;
    void (*call)(const void* self, std::size_t begin, std::size_t end);
  };
  void run(std::size_t count, std::size_t grain, Borrowed body);

  int threads_ = 1;
  std::unique_ptr<Arena> arena_;
};

}  // namespace fingertip::lattice
