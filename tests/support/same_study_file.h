#pragma once
#include <gtest/gtest.h>

#include <bit>
#include <filesystem>

#include "io/hdf5/hdf5_file.h"

namespace asdic::detail::support {

/// Attributes that hold references, whose bits are places in the file.
inline bool is_reference(const std::string& key) {
  return key == "REFERENCE_LIST" || key == "DIMENSION_LIST" || key == "_Netcdf4Dimid";
}

inline void expect_same_attributes(const Hdf5File& a, const Hdf5File& b,
                                   const std::string& object) {
  std::vector<std::string> in_a, in_b;
  for (const std::string& key : a.attributes(object))
    if (!is_reference(key)) in_a.push_back(key);
  for (const std::string& key : b.attributes(object))
    if (!is_reference(key)) in_b.push_back(key);
  EXPECT_EQ(in_a, in_b) << object;
  for (const std::string& key : in_a)
    EXPECT_EQ(a.attribute_texts(object, key), b.attribute_texts(object, key))
        << object << " " << key;
}

/// Bits of a dataset, whatever its type.
inline std::vector<std::uint64_t> bits(const Hdf5File& file, const DatasetInfo& info) {
  std::vector<std::uint64_t> all;
  if (info.type == ElementType::text) {
    for (const char c : file.read_text(info.path)) all.push_back(static_cast<unsigned char>(c));
  } else if (info.type == ElementType::float32) {
    for (const float v : file.read<float>(info.path))
      all.push_back(std::bit_cast<std::uint32_t>(v));
  } else if (info.type == ElementType::float64) {
    for (const double v : file.read<double>(info.path))
      all.push_back(std::bit_cast<std::uint64_t>(v));
  } else {
    for (const std::int64_t v : file.read<std::int64_t>(info.path))
      all.push_back(static_cast<std::uint64_t>(v));
  }
  return all;
}

/// Every dataset and attribute outside of /run is the same in both, to the last bit.
inline void expect_same_study(const std::filesystem::path& first,
                              const std::filesystem::path& second) {
  const Hdf5File a = Hdf5File::open(first), b = Hdf5File::open(second);
  const auto results = [](const Hdf5File& file) {
    std::vector<DatasetInfo> all = file.datasets();
    std::erase_if(all, [](const DatasetInfo& d) {
      return d.path.starts_with("/run/") || d.path.starts_with("run/");
    });
    return all;
  };
  const std::vector<DatasetInfo> in_a = results(a), in_b = results(b);
  ASSERT_EQ(in_a.size(), in_b.size());
  ASSERT_GT(in_a.size(), 5U);
  expect_same_attributes(a, b, "");
  for (std::size_t i = 0; i < in_a.size(); ++i) {
    ASSERT_EQ(in_a[i].path, in_b[i].path);
    EXPECT_EQ(in_a[i].shape, in_b[i].shape) << in_a[i].path;
    EXPECT_EQ(in_a[i].type, in_b[i].type) << in_a[i].path;
    EXPECT_EQ(bits(a, in_a[i]), bits(b, in_b[i])) << in_a[i].path;
    expect_same_attributes(a, b, in_a[i].path);
  }
}

}  // namespace asdic::detail::support
