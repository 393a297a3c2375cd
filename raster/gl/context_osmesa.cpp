// OSMesa: Mesa's software rasterizer drawing into plain memory. The few declarations are those of
// GL/osmesa.h, so that building needs no Mesa headers. It makes GL 4.5 core and no more.
#include <array>
#include <utility>

#include "raster/gl/context.h"
#include "raster/gl/dynamic_library.h"

namespace gnomon::raster {
namespace {

constexpr int osmesa_format = 0x22;
constexpr int osmesa_rgba = 0x1908;
constexpr int osmesa_depth_bits = 0x30;
constexpr int osmesa_profile = 0x33;
constexpr int osmesa_core_profile = 0x34;
constexpr int osmesa_major_version = 0x36;
constexpr int osmesa_minor_version = 0x37;
constexpr unsigned gl_unsigned_byte = 0x1401;

struct OsmesaFunctions {
  void* (*create)(const int*, void*) = nullptr;
  void (*destroy)(void*) = nullptr;
  unsigned char (*make_current)(void*, void*, unsigned, int, int) = nullptr;
  Context::Procedure (*get_procedure)(const char*) = nullptr;

  bool load(const DynamicLibrary& library) {
    return library.find("OSMesaCreateContextAttribs", create) &&
           library.find("OSMesaDestroyContext", destroy) && library.find("OSMesaMakeCurrent", make_current) &&
           library.find("OSMesaGetProcAddress", get_procedure);
  }
};

class OsmesaContext final : public Context {
 public:
  OsmesaContext(DynamicLibrary library, const OsmesaFunctions& functions, void* context)
      : library_(std::move(library)), functions_(functions), context_(context) {}
  OsmesaContext(const OsmesaContext&) = delete;
  OsmesaContext& operator=(const OsmesaContext&) = delete;
  ~OsmesaContext() override { functions_.destroy(context_); }

  bool make_current() override {
    return functions_.make_current(context_, pixels_.data(), gl_unsigned_byte, side, side) != 0;
  }
  Procedure procedure(const char* name) const override { return functions_.get_procedure(name); }
  const char* backend() const override { return "osmesa"; }

 private:
  static constexpr int side =
      16;  ///< the window that OSMesa insists on; all drawing goes to framebuffer objects
  DynamicLibrary library_;
  OsmesaFunctions functions_;
  void* context_;
  std::array<unsigned char, std::size_t{4} * side * side> pixels_{};
};

}  // namespace

Expected<std::unique_ptr<Context>> create_osmesa_context() {
  constexpr std::array names{"libOSMesa.so.8", "libOSMesa.so"};
  auto library = DynamicLibrary::open(names);
  if (!library) return fail(library.error());
  OsmesaFunctions functions;
  if (!functions.load(*library))
    return fail(ErrorKind::graphics, "libOSMesa lacks OSMesaCreateContextAttribs");
  constexpr std::array attributes{osmesa_format,
                                  osmesa_rgba,
                                  osmesa_depth_bits,
                                  0,
                                  osmesa_profile,
                                  osmesa_core_profile,
                                  osmesa_major_version,
                                  4,
                                  osmesa_minor_version,
                                  5,
                                  0};
  void* context = functions.create(attributes.data(), nullptr);
  if (context == nullptr) return fail(ErrorKind::graphics, "OSMesa makes no OpenGL 4.5 core context");
  auto result = std::make_unique<OsmesaContext>(std::move(*library), functions, context);
  if (!result->make_current()) return fail(ErrorKind::graphics, "OSMesaMakeCurrent failed");
  return result;
}

}  // namespace gnomon::raster
