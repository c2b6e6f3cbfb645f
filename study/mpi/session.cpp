#include "study/mpi/session.h"

#include <mpi.h>

#include <cstdint>
#include <cstdlib>

#include "core/error.h"

namespace asdic::detail::study::mpi {

Session::Session(int& argc, char**& argv) {
  int level = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &level);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &size_);
  if (level < MPI_THREAD_FUNNELED)
    throw RunError(
        "this MPI allows one thread a process only; asdic-mpi needs MPI_THREAD_FUNNELED");
}

Session::~Session() {
  int over = 0;
  MPI_Finalized(&over);
  if (over == 0) MPI_Finalize();
}

int Session::ranks_here() const {
  MPI_Comm here = MPI_COMM_NULL;
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, rank_, MPI_INFO_NULL, &here);
  int count = 1;
  MPI_Comm_size(here, &count);
  MPI_Comm_free(&here);
  return count;
}

int Session::first_with(bool here) const {
  int mine = here ? rank_ : size_, lowest = size_;
  MPI_Allreduce(&mine, &lowest, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
  return lowest == size_ ? -1 : lowest;
}

std::string Session::shared(const std::string& text) const {
  std::uint64_t size = text.size();
  MPI_Bcast(&size, 1, MPI_UINT64_T, 0, MPI_COMM_WORLD);
  std::string all = text;
  all.resize(size);
  MPI_Bcast(all.data(), static_cast<int>(size), MPI_BYTE, 0, MPI_COMM_WORLD);
  return all;
}

void Session::abort(int status) const {
  MPI_Abort(MPI_COMM_WORLD, status);
  std::abort();
}

}  // namespace asdic::detail::study::mpi
