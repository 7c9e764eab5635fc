/// A fixed team of threads for the step loop.
#pragma once

#include <cstddef>
#include <memory>

namespace fingertip::lattice::inline threads {

/// Runs loops on at most `threads` threads, the calling one included. The result of a loop must not
/// depend on who runs which of its iterations.
///
/// The others wait for the next loop awake, for longer than the serial parts of a step take, then
/// asleep. Every thread has its share of a loop's pieces, the same in every loop of that length,
/// and when it is through with it takes over what others have not begun: a thread without a core
/// (the machine is busy, it has not woken up yet) holds nobody up. A loop that is begun while
/// another of the same team runs, from within it or by another thread, runs in the calling thread
/// alone.
class Team {
 public:
  /// `threads` = 0 takes all cores.
  explicit Team(int threads);

  int threads() const { return threads_; }

  /// Calls body(begin, end) for pieces that cover [0, count) once, concurrently; `grain` is the
  /// smallest piece worth handing to another thread. Allocates nothing. If bodies throw, the
  /// exception of the first piece that did is thrown once all pieces are done.
  template <typename Body>
  void split(std::size_t count, std::size_t grain, const Body& body) {
    run(count, grain, {&body, [](const void* self, std::size_t begin, std::size_t end) {
                         (*static_cast<const Body*>(self))(begin, end);
                       }});
  }

 private:
  class Crew;
  /// A borrowed callable: unlike std::function it never allocates.
  struct Borrowed {
    const void* self = nullptr;
    void (*call)(const void* self, std::size_t begin, std::size_t end) = nullptr;
  };
  void run(std::size_t count, std::size_t grain, Borrowed body);

  int threads_ = 1;
  std::shared_ptr<Crew> crew_;  ///< null for one thread
};

}  // namespace fingertip::lattice::inline threads
