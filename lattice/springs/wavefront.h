/// Threads that march a lattice through time together, each in a time step of its own.
#pragma once

#include <cstdint>
#include <memory>

namespace fingertip::lattice::springs {

/// Sweeps planes 0, 1, ... of step after step, where plane z of a step needs planes up to z + 1 of
/// the step before and leaves the planes below z alone. A thread takes the next step that nobody
/// has taken and stays two planes behind the step before: no barrier, and every step does the same
/// whoever takes it. Waiting threads spin, and yield their core when that takes long. A thread that
/// gets no core takes no step, and the others go on without it.
class Wavefront {
 public:
  /// Makes `threads` - 1 threads ready besides the calling one; they sleep between runs.
  explicit Wavefront(int threads);
  ~Wavefront();
  Wavefront(const Wavefront&) = delete;
  Wavefront& operator=(const Wavefront&) = delete;

  int threads() const;

  /// Calls sweep(thread, plane) for every plane of `steps` steps on `threads` threads of those made
  /// ready, 0 being the calling one. Allocates nothing; `sweep` must not throw.
  template <typename Sweep>
  void run(int steps, int planes, int threads, const Sweep& sweep) {
    run(steps, planes, threads, {&sweep, [](const void* self, int thread, int plane) {
                                   (*static_cast<const Sweep*>(self))(thread, plane);
                                 }});
  }

 private:
  struct Crew;
  /// A borrowed callable: unlike std::function it never allocates.
  struct Borrowed {
    const void* self = nullptr;
    void (*call)(const void* self, int thread, int plane) = nullptr;
  };
  struct Task {
    int steps = 0, planes = 0, threads = 1;
    std::int64_t run = 0;  ///< number of this task
    Borrowed sweep;
  };
  void run(int steps, int planes, int threads, Borrowed sweep);

  std::unique_ptr<Crew> crew_;
};

}  // namespace fingertip::lattice::springs
