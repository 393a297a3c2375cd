// MTL files, read through an OBJ file that uses their materials, with textures for them to name.
#include "fuzz_target.h"
#include "scene/files/pictures/image_io.h"

namespace {

std::string write_obj() {
  gnomon::Texture leaf;
  leaf.size = {2, 1};
  leaf.texels = {{200, 100, 50, 255}, {200, 100, 50, 0}};
  const auto png = gnomon::encode_png(leaf);
  if (!png) gnomon::fuzz::broken("no texture");
  gnomon::fuzz::put("leaf.png", *png);
  gnomon::fuzz::put("bark 1.png", *png);
  return gnomon::fuzz::put("input.obj",
                           "mtllib input.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
                           "usemtl a\nf 1 2 3\nusemtl b c\nf 1 2 4\n");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::string obj = write_obj();
  gnomon::fuzz::put("input.mtl", {reinterpret_cast<const char*>(data), size});
  gnomon::fuzz::load(obj);
  return 0;
}

std::vector<std::string> gnomon::fuzz::seeds() {
  return {
      "newmtl a\nKd 0.8 0.1 0.1\nKs 0.5\nNs 96\nd 0.5\nillum 2\nmap_Kd -s 2 1 1 leaf.png\nmap_d -clamp on "
      "bark 1.png\n",
      "# Windows\r\nnewmtl a\r\nKd .5 5e-1 1\r\nmap_Kd .\\leaf.png\r\nmap_d leaf.png\r\nnewmtl b c\r\nTr "
      "0.25\r\nNi 1.5\r\n"
      "illum 7\r\nTf 0.9 0.9 0.9\r\n",
      "newmtl a\rKd \\\n 0.1 0.2 0.3\rd -halo 0.5\rKe 1 1 1\rnewmtl b c\rKd spectral a.rfl\rmap_d "
      "leaf.png\rbump -bm 1 none.png\r"};
}
