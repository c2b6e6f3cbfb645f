#include "io/climatology/gdal_raster.h"

#include "core/error.h"

// ASDIC_GDAL is the name of GDAL's shared library, of cmake/AsdicGdal.cmake; without GDAL it is not
// there.
#ifdef ASDIC_GDAL
#include <cpl_error.h>
#include <dlfcn.h>
#include <gdal.h>
#include <ogr_srs_api.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "core/text.h"
#include "core/units.h"
#include "io/climatology/words.h"
#include "io/isolated/pack.h"
#include "raytrace/area/map_frame.h"

namespace asdic::detail::gdal {
namespace {

using climatology::lower;

constexpr int longest_axis = 10'000'000;
constexpr GIntBig cache = GIntBig{128} << 20;  // of unpacked tiles [bytes]
constexpr const char *a_picture = "a picture, of colours",
                     *numbers_with_a_unit = "a band of numbers";
constexpr double none = std::numeric_limits<double>::quiet_NaN();

#define ASDIC_GDAL_FUNCTIONS(has)                                                                  \
  has(GDALAllRegister) has(GDALSetCacheMax64) has(GDALOpenEx) has(GDALClose) has(                  \
      GDALGetGeoTransform) has(GDALGetRasterXSize) has(GDALGetRasterYSize) has(GDALGetRasterCount) \
      has(GDALGetRasterBand) has(GDALGetRasterDataType) has(GDALDataTypeIsComplex)                 \
          has(GDALGetDescription) has(GDALGetMetadataItem) has(GDALGetRasterNoDataValue)           \
              has(GDALGetRasterScale) has(GDALGetRasterOffset) has(GDALGetRasterUnitType)          \
                  has(GDALGetRasterCategoryNames) has(GDALGetRasterColorInterpretation)            \
                      has(GDALGetMaskFlags) has(GDALGetMaskBand) has(GDALRasterIO)                 \
                          has(GDALGetSpatialRef) has(OSRIsLocal) has(OSRIsGeographic)              \
                              has(OSRIsProjected) has(OSRGetName) has(OSRGetLinearUnits)           \
                                  has(OSRGetAngularUnits) has(OSRGetPrimeMeridian)                 \
                                      has(OSRExportToProj4) has(OSRNewSpatialReference)            \
                                          has(OSRImportFromEPSG) has(OSRSetAxisMappingStrategy)    \
                                              has(OSRClone) has(OSRDestroySpatialReference)        \
                                                  has(OCTNewCoordinateTransformation)              \
                                                      has(OCTTransform)                            \
                                                          has(OCTDestroyCoordinateTransformation)  \
                                                              has(CPLPushErrorHandler)             \
                                                                  has(CPLQuietErrorHandler)        \
                                                                      has(CPLGetLastErrorMsg)      \
                                                                          has(CPLErrorReset)       \
                                                                              has(VSIFree)

/// The functions of GDAL's library: it is loaded where a raster is opened, and nowhere else. It
/// takes a hundred libraries with it, and 0.1 s.
struct Library {
#define ASDIC_GDAL_MEMBER(name) decltype(&::name) name = nullptr;
  ASDIC_GDAL_FUNCTIONS(ASDIC_GDAL_MEMBER)
#undef ASDIC_GDAL_MEMBER

  /// \param path, kind  of a raster, for the message if there is no such library
  Library(const std::filesystem::path& path, const std::string& kind) {
    void* const handle = dlopen(ASDIC_GDAL, RTLD_NOW | RTLD_LOCAL);
    const auto check = [&](const void* found) {
      if (found != nullptr) return;
      const char* const why = dlerror();
      throw InputError(
          {.where = path.string(),
           .got = kind + ", and no GDAL to read it (" + (why != nullptr ? why : ASDIC_GDAL) + ")",
           .expected = "the library " ASDIC_GDAL " (Debian's libgdal32), or netCDF, "
                       "as \"gdal_translate -of netCDF\" makes it"});
    };
    check(handle);
#define ASDIC_GDAL_FIND(name)                                    \
  name = reinterpret_cast<decltype(name)>(dlsym(handle, #name)); \
  check(reinterpret_cast<const void*>(name));
    ASDIC_GDAL_FUNCTIONS(ASDIC_GDAL_FIND)
#undef ASDIC_GDAL_FIND
    GDALAllRegister();
    GDALSetCacheMax64(cache);
    CPLPushErrorHandler(CPLQuietErrorHandler);
  }
};

/// A band of a raster, open. It lives as long as the child process.
class Raster {
 public:
  Raster(std::filesystem::path path, std::string kind, const RasterBand& asked)
      : path_(std::move(path)), kind_(std::move(kind)), gdal_(path_, kind_) {
    // GeoTIFF, and grids of ESRI's as Arc/Info has them or with a header: no driver by which a file
    // leads to others, or of a library that others of our readers have open.
    const std::array<const char*, 4> drivers{"GTiff", "AIG", "EHdr", nullptr};
    file_ = gdal_.GDALOpenEx(path_.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, drivers.data(),
                             nullptr, nullptr);
    if (file_ == nullptr)
      throw fault("a file that cannot be opened" + last_error(), kind_ + " that GDAL can read");
    find_band(asked);
    if (band_ == nullptr) return;
    variable_.found = true;
    read_band(asked);
    read_axes();
    read_reference();
  }
  Raster(const Raster&) = delete;
  Raster& operator=(const Raster&) = delete;
  ~Raster() {
    if (to_earth_ != nullptr) gdal_.OCTDestroyCoordinateTransformation(to_earth_);
    gdal_.GDALClose(file_);
  }

  [[nodiscard]] std::string answer(std::string_view asked) const {
    isolated::Packed out;
    if (asked.empty()) {
      out.put(variable_);
      return out.bytes();
    }
    isolated::Unpacked question(asked);
    if (question.get<Question>() == Question::part)
      out.put(values_of(question.get<GridPart>()));
    else
      out.put(on_earth(question.get<std::vector<double>>()));
    return out.bytes();
  }

 private:
  [[nodiscard]] InputError fault(const std::string& got, const std::string& expected) const {
    return InputError(
        {.where = path_.string() + (variable_.name.empty() ? "" : ": ") + variable_.name,
         .got = got,
         .expected = expected});
  }
  [[nodiscard]] std::string last_error() const {
    const std::string said = gdal_.CPLGetLastErrorMsg();
    return said.empty() ? "" : " (" + said + ")";
  }
  [[nodiscard]] std::string item(GDALMajorObjectH of, const char* key) const {
    const char* const text = gdal_.GDALGetMetadataItem(of, key, "");
    return text == nullptr ? "" : text;
  }

  void find_band(const RasterBand& asked);
  void read_band(const RasterBand& asked);
  void read_axes();
  void read_reference();
  void read_geographic(OGRSpatialReferenceH reference);
  void open_way_to_earth(OGRSpatialReferenceH reference);
  [[nodiscard]] std::vector<double> values_of(const GridPart& part) const;
  [[nodiscard]] std::vector<double> on_earth(std::vector<double> place) const;

  std::filesystem::path path_;
  std::string kind_;
  Library gdal_;
  GDALDatasetH file_ = nullptr;
  GDALRasterBandH band_ = nullptr;
  OGRCoordinateTransformationH to_earth_ = nullptr;
  bool masked_ = false;
  double metres_ = 1.0;  // of the unit of projected axes
  GridVariable variable_;
};

void Raster::find_band(const RasterBand& asked) {
  int count = gdal_.GDALGetRasterCount(file_);
  const auto colour = [&](int k) {
    return gdal_.GDALGetRasterColorInterpretation(gdal_.GDALGetRasterBand(file_, k));
  };
  if (count > 1 && colour(count) == GCI_AlphaBand) --count;  // a mask, which is heeded
  if (asked.named.empty() && count > 1 && colour(1) == GCI_RedBand)
    throw fault(a_picture, numbers_with_a_unit);
  const auto described = [&](int k) {
    return lower(gdal_.GDALGetDescription(gdal_.GDALGetRasterBand(file_, k)));
  };
  int number = 0;
  std::string word = lower(asked.named), known;
  if (word.starts_with("band ")) word.erase(0, 5);
  for (int k = 1; k <= count && number == 0; ++k) {
    const std::string what = described(k);
    if (!what.empty()) known += (known.empty() ? ": " : ", ") + std::to_string(k) + " " + what;
    if (!word.empty() && (word == std::to_string(k) || word == what)) number = k;
  }
  if (number == 0 && !word.empty())
    throw fault("no band " + in_quotes(asked.named),
                count == 1 ? "FILE alone: it has one band"
                           : "FILE:BAND with a number from 1 to " + std::to_string(count) + known);
  if (number == 0 && count == 1) number = 1;
  for (const std::string& name : asked.names)
    for (int k = 1; k <= count && number == 0; ++k)
      if (described(k) == lower(name)) number = k;
  if (number == 0 && !asked.required) return;
  if (number == 0)
    throw fault(count == 0 ? "no band" : std::to_string(count) + " bands",
                count == 0 ? "a raster with one"
                           : "FILE:BAND with a number from 1 to " + std::to_string(count) + known);
  band_ = gdal_.GDALGetRasterBand(file_, number);
  variable_.name = "band " + std::to_string(number);
}

void Raster::read_band(const RasterBand& asked) {
  const std::string described = gdal_.GDALGetDescription(band_);
  variable_.long_name = described.empty() ? item(band_, "long_name") : described;
  variable_.standard_name = item(band_, "standard_name");
  variable_.units = gdal_.GDALGetRasterUnitType(band_);
  if (variable_.units.empty()) variable_.units = item(band_, "units");
  if (gdal_.GDALDataTypeIsComplex(gdal_.GDALGetRasterDataType(band_)) != 0)
    throw fault("complex numbers", "real ones");
  const GDALColorInterp colour = gdal_.GDALGetRasterColorInterpretation(band_);
  const bool palette = colour == GCI_PaletteIndex;
  if ((palette && !asked.colours) || (colour >= GCI_RedBand && colour <= GCI_YCbCr_CrBand))
    throw fault(palette ? "colours of a palette" : a_picture, numbers_with_a_unit);
  int has = 0;
  if (const double flag = gdal_.GDALGetRasterNoDataValue(band_, &has); has != 0)
    variable_.missing_values.push_back(flag);
  if (const double scale = gdal_.GDALGetRasterScale(band_, &has); has != 0) variable_.scale = scale;
  if (const double offset = gdal_.GDALGetRasterOffset(band_, &has); has != 0)
    variable_.offset = offset;
  masked_ = (gdal_.GDALGetMaskFlags(band_) & (GMF_PER_DATASET | GMF_ALPHA)) != 0;
  if (char** names = gdal_.GDALGetRasterCategoryNames(band_))
    for (int value = 0; names[value] != nullptr; ++value) {
      std::string name = names[value];
      if (name.empty()) continue;
      std::replace(name.begin(), name.end(), ' ', '_');
      variable_.flag_meanings += (variable_.flag_meanings.empty() ? "" : " ") + name;
      variable_.flag_values.push_back(value);
    }
}

void Raster::read_axes() {
  const int columns = gdal_.GDALGetRasterXSize(file_), rows = gdal_.GDALGetRasterYSize(file_);
  if (columns > longest_axis || rows > longest_axis)
    throw fault(std::to_string(columns) + " by " + std::to_string(rows) + " pixels",
                "at most 1e7 either way");
  std::array<double, 6> place{};
  if (gdal_.GDALGetGeoTransform(file_, place.data()) != CE_None)
    throw fault("pixels without places: no geotransform",
                "a georeferenced raster: \"gdalwarp\" makes one where there are control points");
  if (place[2] != 0.0 || place[4] != 0.0)
    throw fault("a rotated raster: its rows turned by " +
                    to_text(std::round(10.0 * degrees(std::atan2(place[4], place[1]))) / 10.0) +
                    " degrees",
                "rows and columns along its axes: \"gdalwarp\" makes such");
  if (!(place[1] != 0.0 && place[5] != 0.0 && std::isfinite(place[1] + place[5]) &&
        std::isfinite(place[0] + place[3])))
    throw fault("pixels of " + to_text(place[1]) + " by " + to_text(place[5]),
                "pixels of some size");
  const auto axis = [&](GridAxis what, const char* name, int size, double first, double step) {
    GridDimension dimension{.name = name, .known = true, .axis = what};
    for (int i = 0; i < size; ++i) dimension.values.push_back(first + step * (i + 0.5));
    variable_.dimensions.push_back(std::move(dimension));
  };
  axis(GridAxis::latitude, "y", rows, place[3], place[5]);
  axis(GridAxis::longitude, "x", columns, place[0], place[1]);
}

/// Whether the axes are degrees or lengths, and of what.
void Raster::read_reference() {
  const OGRSpatialReferenceH reference = gdal_.GDALGetSpatialRef(file_);
  if (reference == nullptr || gdal_.OSRIsLocal(reference) != 0)
    throw fault(
        "no coordinate reference system",
        "one: \"gdal_translate -a_srs EPSG:4326 IN OUT\" gives it longitudes and latitudes");
  const char* const called = gdal_.OSRGetName(reference);
  const std::string name = called == nullptr ? "a system without a name" : called;
  if (gdal_.OSRIsGeographic(reference) != 0) {
    read_geographic(reference);
  } else if (gdal_.OSRIsProjected(reference) != 0) {
    metres_ = gdal_.OSRGetLinearUnits(reference, nullptr);
    for (GridDimension& dimension : variable_.dimensions) {
      dimension.projected = true;
      for (double& x : dimension.values) x *= metres_;
    }
    variable_.projection_name = name;
    char* text = nullptr;
    if (gdal_.OSRExportToProj4(reference, &text) == OGRERR_NONE && text != nullptr)
      variable_.projection = text;
    gdal_.VSIFree(text);
    if (variable_.projection.empty()) variable_.projection = name;
    open_way_to_earth(reference);
  } else {
    throw fault(
        "a coordinate reference system, " + name + ", that is neither geographic nor projected",
        "longitudes and latitudes, or a projection: \"gdalwarp -t_srs\" makes such");
  }
}

void Raster::read_geographic(OGRSpatialReferenceH reference) {
  char* from = nullptr;
  const double meridian = gdal_.OSRGetPrimeMeridian(reference, &from);
  if (std::abs(meridian) > 1e-9)
    throw fault(
        "longitudes from the meridian of " + std::string(from == nullptr ? "another place" : from),
        "from Greenwich: \"gdalwarp -t_srs EPSG:4326\" makes such");
  if (std::abs(gdal_.OSRGetAngularUnits(reference, nullptr) / radians(1.0) - 1.0) > 1e-6)
    throw fault("longitudes and latitudes in another unit", "degrees");
  const auto& x = variable_.dimensions[1].values;
  const auto& y = variable_.dimensions[0].values;
  for (const double latitude : {y.front(), y.back()})
    if (std::abs(latitude) > 90.0 + 1e-6)
      throw fault("a latitude of " + to_text(latitude) + " degrees", "-90 to 90");
  if (std::abs(x.back() - x.front()) > 360.0 + 1e-6)
    throw fault("longitudes over " + to_text(std::abs(x.back() - x.front())) + " degrees",
                "at most 360");
  // Another datum: places are taken as they stand, and how far off that is is told.
  open_way_to_earth(reference);
  const double east = 0.5 * (x.front() + x.back()), north = 0.5 * (y.front() + y.back());
  const std::vector<double> there = on_earth({east, north});
  if (there.empty() || std::abs(north) > 89.0) return;
  const double off = MapFrame::geographic({there[1], there[0]}).on_map(east, north).norm();
  if (off > 20.0)
    variable_.remarks.push_back(path_.filename().string() + " is in " +
                                gdal_.OSRGetName(reference) +
                                ": its places were taken as those of "
                                "WGS 84, " +
                                to_text(std::round(off)) + " m off");
}

void Raster::open_way_to_earth(OGRSpatialReferenceH reference) {
  const OGRSpatialReferenceH from = gdal_.OSRClone(reference),
                             earth = gdal_.OSRNewSpatialReference(nullptr);
  if (gdal_.OSRImportFromEPSG(earth, 4326) == OGRERR_NONE) {
    for (const OGRSpatialReferenceH one : {from, earth})
      gdal_.OSRSetAxisMappingStrategy(one, OAMS_TRADITIONAL_GIS_ORDER);  // east before north
    to_earth_ = gdal_.OCTNewCoordinateTransformation(from, earth);
  }
  gdal_.OSRDestroySpatialReference(from);
  gdal_.OSRDestroySpatialReference(earth);
}

std::vector<double> Raster::on_earth(std::vector<double> place) const {
  if (to_earth_ == nullptr || place.size() != 2) return {};
  double x = place[0] / metres_, y = place[1] / metres_;
  if (gdal_.OCTTransform(to_earth_, 1, &x, &y, nullptr) == 0) return {};
  if (!std::isfinite(x) || !std::isfinite(y)) return {};
  return {x, y};
}

std::vector<double> Raster::values_of(const GridPart& part) const {
  const int row = static_cast<int>(part.start.at(0)), rows = static_cast<int>(part.count.at(0)),
            column = static_cast<int>(part.start.at(1)),
            columns = static_cast<int>(part.count.at(1));
  std::vector<double> values(part.count[0] * part.count[1]);
  gdal_.CPLErrorReset();
  const auto read = [&](GDALRasterBandH from, void* to, GDALDataType type) {
    if (gdal_.GDALRasterIO(from, GF_Read, column, row, columns, rows, to, columns, rows, type, 0,
                           0) != CE_None)
      throw fault("pixels that cannot be read" + last_error(), "a whole file");
  };
  read(band_, values.data(), GDT_Float64);
  if (!masked_) return values;
  std::vector<unsigned char> mask(values.size());
  read(gdal_.GDALGetMaskBand(band_), mask.data(), GDT_Byte);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (mask[i] == 0) values[i] = none;
  return values;
}

}  // namespace

bool is_built() noexcept { return true; }

isolated::Child::Answer open(const std::filesystem::path& path, const std::string& kind,
                             const RasterBand& band) {
  auto raster = std::make_shared<const Raster>(path, kind, band);
  return [raster](std::string_view question) { return raster->answer(question); };
}

}  // namespace asdic::detail::gdal

#else

namespace asdic::detail::gdal {

bool is_built() noexcept { return false; }

isolated::Child::Answer open(const std::filesystem::path& path, const std::string& kind,
                             const RasterBand& band) {
  static_cast<void>(band);
  throw InputError({.where = path.string(), .got = kind, .expected = "a netCDF file"});
}

}  // namespace asdic::detail::gdal

#endif
