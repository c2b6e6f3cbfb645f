#include "io/climatology/raster_source.h"

#include <array>

#include "core/error.h"
#include "io/climatology/gdal_raster.h"
#include "io/climatology/words.h"
#include "io/files/files_read.h"
#include "io/files/input_file.h"
#include "io/isolated/child.h"
#include "io/isolated/pack.h"

namespace asdic::detail {
namespace {

constexpr const char* esri_binary = "a binary grid of ESRI's";

/// A file beside another, that has its name but for the ending, in small or capital letters.
bool has_header(const std::filesystem::path& path) {
  for (const char* ending : {".hdr", ".HDR"})
    if (std::filesystem::is_regular_file(std::filesystem::path(path).replace_extension(ending)))
      return true;
  return false;
}

class RasterSource : public GridSource {
 public:
  /// Strips and tiles are unpacked whole, those of a wide window many at a time.
  static constexpr isolated::Limits limits{.processor = std::chrono::seconds(20)};

  RasterSource(const std::filesystem::path& path, const std::string& kind, const RasterBand& band)
      : child_(
            path, "GDAL", [&] { return gdal::open(path, kind, band); }, limits),
        variable_(isolated::Unpacked(child_.ask("")).get<GridVariable>()) {}

  const GridVariable& variable() const noexcept override { return variable_; }

  std::vector<double> read(const GridPart& part) const override {
    isolated::Packed question;
    question.put(gdal::Question::part);
    question.put(part);
    return isolated::Unpacked(child_.ask(question.bytes())).get<std::vector<double>>();
  }

  std::optional<Place> on_earth(double x, double y) const override {
    isolated::Packed question;
    question.put(gdal::Question::place);
    question.put(std::vector<double>{x, y});
    const auto place = isolated::Unpacked(child_.ask(question.bytes())).get<std::vector<double>>();
    if (place.empty()) return std::nullopt;
    return Place{.longitude = place[0], .latitude = place[1]};
  }

 private:
  mutable isolated::Child child_;  // asked, it goes on
  GridVariable variable_;
};

}  // namespace

std::optional<std::string> raster_kind(const std::filesystem::path& path) {
  if (std::filesystem::is_directory(path)) {
    if (std::filesystem::is_regular_file(path / "hdr.adf")) return esri_binary;
    return std::nullopt;
  }
  const std::string ending = climatology::lower(path.extension().string());
  if (ending == ".adf") return esri_binary;
  for (const char* of_esri : {".flt", ".bil", ".bip", ".bsq"})
    if (ending == of_esri && has_header(path)) return esri_binary;
  using namespace std::string_literals;
  const std::string start = InputFile(path, "a file of gridded data").read(4);
  for (const std::string& tiff : {"II*\0"s, "MM\0*"s, "II+\0"s, "MM\0+"s})
    if (start == tiff) return "a GeoTIFF";
  return std::nullopt;
}

std::filesystem::path raster_values(const std::filesystem::path& path) {
  const std::filesystem::path values = path / "w001001.adf";
  return std::filesystem::is_directory(path) && std::filesystem::is_regular_file(values) ? values
                                                                                         : path;
}

bool reads_rasters() noexcept { return gdal::is_built(); }

std::unique_ptr<const GridSource> open_raster(const std::filesystem::path& path,
                                              const RasterBand& band) {
  const std::string kind = raster_kind(path).value_or("a raster");
  if (!reads_rasters())
    throw InputError(
        {.where = path.string(),
         .got = kind,
         .expected = "a netCDF file: \"gdal_translate -of netCDF " + path.filename().string() +
                     " NEW.nc\" makes one, with the variable Band1; or an asdic that is "
                     "built with GDAL"});
  note_read(raster_values(path));
  return std::make_unique<const RasterSource>(path, kind, band);
}

}  // namespace asdic::detail
