#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

namespace asdic::detail::hdf5 {

/// The checksum that HDF5's Fletcher-32 filter puts behind a chunk, as the library computes it:
/// over words of 16 bits, the first byte the higher one, sums modulo 65535 (J. G. Fletcher, IEEE
/// Trans. Commun. 30, 247, 1982). \param bytes  an even number of them
[[nodiscard]] std::uint32_t fletcher32(std::span<const std::byte> bytes);

}  // namespace asdic::detail::hdf5
