#include "studies/cli/command_line/standard_streams.h"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <iostream>
#include <utility>

namespace fingertip::studies::inline cli::inline command_line {

namespace {

std::FILE* stream_over(void* sink, cookie_write_function_t* write, int descriptor) {
  std::FILE* const stream = ::fopencookie(sink, "w", {nullptr, write, nullptr, nullptr});
  if (stream != nullptr && descriptor == STDERR_FILENO) std::setvbuf(stream, nullptr, _IONBF, 0);
  if (stream != nullptr && ::isatty(descriptor) == 1) std::setvbuf(stream, nullptr, _IOLBF, 0);
  return stream;
}

}  // namespace

StandardStreams::StandardStreams()
    : out_{STDOUT_FILENO, 0}, err_{STDERR_FILENO, 0}, own_out_(stdout), own_err_(stderr) {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    // The lowest free one is taken, which is this one.
    if (::fcntl(descriptor, F_GETFD) < 0) ::open("/dev/null", O_RDWR);
  }
  ::signal(SIGPIPE, SIG_IGN);
  ::signal(SIGXFSZ, SIG_IGN);
  if (std::FILE* const out = stream_over(&out_, write, STDOUT_FILENO)) stdout = out;
  if (std::FILE* const err = stream_over(&err_, write, STDERR_FILENO)) stderr = err;
}

StandardStreams::~StandardStreams() {
  for (auto [stream, own] : {std::pair{&stdout, own_out_}, std::pair{&stderr, own_err_}}) {
    if (*stream != own) std::fclose(std::exchange(*stream, own));
  }
}

ssize_t StandardStreams::write(void* sink, const char* bytes, std::size_t count) {
  Sink& to = *static_cast<Sink*>(sink);
  for (std::size_t done = 0; done < count && to.error == 0;) {
    const ssize_t written = ::write(to.descriptor, bytes + done, count - done);
    if (written >= 0)
      done += std::size_t(written);
    else if (errno != EINTR && errno != EAGAIN)
      to.error = errno;
  }
  return ssize_t(count);
}

int StandardStreams::lost() {
  std::fflush(stdout);
  errno = 0;
  if (!std::cout.flush() && out_.error == 0) out_.error = errno != 0 ? errno : EIO;
  return out_.error == EPIPE ? 0 : out_.error;
}

}  // namespace fingertip::studies::inline cli::inline command_line
