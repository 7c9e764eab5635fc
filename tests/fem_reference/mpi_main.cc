// main() of the test programs that need MPI, whether started under mpirun or not. Only rank 0
// prints, and every rank fails if any does, so that mpirun's exit code is the verdict.
#include <deal.II/base/mpi.h>
#include <gtest/gtest.h>

#include <sstream>
#include <string>

namespace {

/// Says on standard error which rank failed where: a failure away from rank 0 must not be silent.
class RankReporter : public testing::EmptyTestEventListener {
 public:
  explicit RankReporter(unsigned rank) : rank_(rank) {}

  void OnTestPartResult(const testing::TestPartResult& part) override {
    if (!part.failed()) return;
    std::ostringstream text;
    text << "rank " << rank_ << ": " << (part.file_name() ? part.file_name() : "?") << ":"
         << part.line_number() << ": " << part.message() << "\n";
    std::fputs(text.str().c_str(), stderr);
  }

 private:
  unsigned rank_;
};

}  // namespace

int main(int argc, char** argv) {
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  testing::InitGoogleTest(&argc, argv);
  const unsigned rank = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
  if (rank != 0) {
    testing::TestEventListeners& listeners = testing::UnitTest::GetInstance()->listeners();
    delete listeners.Release(listeners.default_result_printer());
    listeners.Append(new RankReporter(rank));  // gtest takes ownership
  }
  const int failed = RUN_ALL_TESTS();
  return dealii::Utilities::MPI::max(failed, MPI_COMM_WORLD);
}
