/// What the program says must not decide about what it computes.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdio>

namespace fingertip::studies::inline cli::inline command_line {

/// While it lives, standard output and standard error swallow what cannot be written, where
/// otherwise a broken pipe or a full disk would end a run half way: SIGPIPE and SIGXFSZ are ignored
/// (for child processes, too), and standard descriptors that are closed lead to /dev/null, since
/// the next file that is opened would take their place.
class StandardStreams {
 public:
  StandardStreams();
  ~StandardStreams();
  StandardStreams(const StandardStreams&) = delete;
  StandardStreams& operator=(const StandardStreams&) = delete;

  /// errno of the first write to standard output that failed, after all has been written; 0 when
  /// none has, or when only the reader has gone, who has then seen what he wanted.
  int lost();

 private:
  struct Sink {
    int descriptor;
    int error;  ///< errno of the first failure, 0: none
  };
  static ssize_t write(void* sink, const char* bytes, std::size_t count);

  Sink out_, err_;
  std::FILE *own_out_, *own_err_;
};

}  // namespace fingertip::studies::inline cli::inline command_line
