// Captures of other renderers' shadows; the files that they name are not opened.
#include "fuzz_target.h"
#include "judge/capture.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gnomon;
  const std::string path = fuzz::put("capture.json", {reinterpret_cast<const char*>(data), size});
  const Expected<judge::Capture> capture = judge::read_capture(path);
  fuzz::note_read(capture ? nullptr : &capture.error());
  if (!capture) return 0;
  if (const Expected<void> whole = judge::check_capture(*capture); !whole)
    if (whole.error().kind != ErrorKind::bad_input)
      fuzz::broken("an error of another kind: " + whole.error().message());
  return 0;
}

std::vector<std::string> gnomon::fuzz::seeds() {
  return {
      R"({
  "schema": "gnomon/capture/1", "renderer": { "name": "three.js", "version": "0.170", "settings": { "type": "PCF", "size": 512 } },
  "scene": "fence", "camera": "0", "light": "sun", "size": [64, 36],
  "visibility": "v.exr", "depth": { "file": "z.exr", "convention": "reversed", "near": 0.1, "far": 100 },
  "map": [{ "depth": "m.exr", "convention": "zero_to_one", "rows": "bottom_up",
    "clip_from_world": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1] }],
  "bias": { "constant_depth": 0.001, "slope": 1, "normal_offset_world": 0.02 },
  "filter": { "kind": "pcf", "radius_texels": 2 }
})",
      R"({"schema":"gnomon/capture/1","renderer":{"name":"a"},"scene":"s.glb","size":[8,8],"shadowed":"a.png","unshadowed":"b.png","position":"p.exr"})"};
}
