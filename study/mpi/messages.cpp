#include "study/mpi/messages.h"

#include <mpi.h>

#include <cstring>

namespace asdic::detail::study::mpi {
namespace {

template <class T>
void put(std::vector<std::byte>& into, const T& value) {
  const auto* bytes = reinterpret_cast<const std::byte*>(&value);
  into.insert(into.end(), bytes, bytes + sizeof value);
}

template <class T>
T take(const std::vector<std::byte>& from, std::size_t& at) {
  T value{};
  std::memcpy(&value, from.data() + at, sizeof value);
  at += sizeof value;
  return value;
}

}  // namespace

void send(int rank, Tag tag, const std::vector<std::byte>& bytes) {
  MPI_Send(bytes.data(), static_cast<int>(bytes.size()), MPI_BYTE, rank, static_cast<int>(tag),
           MPI_COMM_WORLD);
}

std::optional<Message> receive() {
  int there = 0;
  MPI_Status status;
  MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &there, &status);
  if (there == 0) return {};
  int size = 0;
  MPI_Get_count(&status, MPI_BYTE, &size);
  Message message{.rank = status.MPI_SOURCE,
                  .tag = static_cast<Tag>(status.MPI_TAG),
                  .bytes = std::vector<std::byte>(static_cast<std::size_t>(size))};
  MPI_Recv(message.bytes.data(), size, MPI_BYTE, message.rank, status.MPI_TAG, MPI_COMM_WORLD,
           MPI_STATUS_IGNORE);
  return message;
}

std::vector<std::byte> packed(const std::vector<Row>& rows) {
  std::vector<std::byte> bytes;
  for (const Row& row : rows) {
    put(bytes, row.index);
    put(bytes, std::uint64_t{row.valid});
    put(bytes, std::uint64_t{row.values.size()});
    for (const double value : row.values) put(bytes, value);
  }
  return bytes;
}

std::vector<Row> rows_of(const std::vector<std::byte>& bytes) {
  std::vector<Row> rows;
  for (std::size_t at = 0; at < bytes.size();) {
    Row row{.index = take<std::uint64_t>(bytes, at)};
    row.valid = take<std::uint64_t>(bytes, at) != 0;
    row.values.resize(take<std::uint64_t>(bytes, at));
    for (double& value : row.values) value = take<double>(bytes, at);
    rows.push_back(std::move(row));
  }
  return rows;
}

std::vector<std::byte> packed(const IndexRange& range) {
  std::vector<std::byte> bytes;
  put(bytes, range.first);
  put(bytes, range.end);
  return bytes;
}

IndexRange range_of(const std::vector<std::byte>& bytes) {
  std::size_t at = 0;
  const auto first = take<std::uint64_t>(bytes, at);
  return {first, take<std::uint64_t>(bytes, at)};
}

std::vector<std::byte> packed(const std::string& text) {
  const auto* bytes = reinterpret_cast<const std::byte*>(text.data());
  return {bytes, bytes + text.size()};
}

std::string text_of(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace asdic::detail::study::mpi
