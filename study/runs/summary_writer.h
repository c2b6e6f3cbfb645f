#pragma once
#include <functional>
#include <string>
#include <vector>

#include "io/hdf5/hdf5_file.h"
#include "study/summary/summary.h"

// The tables of a summary in a file: docs/formats/study-results.md.
namespace asdic::detail::study {

/// Told of every dataset and its values.
using Noted = std::function<void(const std::string& dataset, const std::vector<double>& values)>;

/// Writes the group /summary: a group for each table, with what its intervals are.
void write_summary(Hdf5File& file, const Summary& summary, const Noted& noted);

/// Says of a dataset what a column is: meaning, units, reference, labels.
void describe_column(Hdf5File& file, const std::string& dataset, const Column& column);

}  // namespace asdic::detail::study
