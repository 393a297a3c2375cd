#include "embree_peer.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstring>

#include "raytrace/packets/tile.h"
#include "raytrace/tiles.h"
#include "scene/light.h"

namespace gnomon::bench {
namespace {

using raytrace::tile_lane;
using raytrace::tile_rays;
using raytrace::TileGrid;

PeerRays empty_rays(ImageSize size) {
  PeerRays rays;
  rays.tiles = TileGrid{size}.count();
  const std::size_t n = rays.tiles * tile_rays;
  for (auto* v : {&rays.ox, &rays.oy, &rays.oz, &rays.dx, &rays.dy, &rays.dz, &rays.far}) v->resize(n);
  rays.valid.resize(n);
  return rays;
}

void put(PeerRays& rays, std::size_t at, const Vec3& origin, const Vec3& direction, double far) {
  rays.ox[at] = static_cast<float>(origin.x), rays.oy[at] = static_cast<float>(origin.y);
  rays.oz[at] = static_cast<float>(origin.z), rays.dx[at] = static_cast<float>(direction.x);
  rays.dy[at] = static_cast<float>(direction.y), rays.dz[at] = static_cast<float>(direction.z);
  rays.far[at] = static_cast<float>(far), rays.valid[at] = -1;
  ++rays.count;
}

/// Leaves out what is not to be traced.
void close_up(PeerRays& rays) {
  std::size_t to = 0;
  for (std::size_t from = 0; from < rays.valid.size(); ++from) {
    if (rays.valid[from] == 0) continue;
    for (auto* v : {&rays.ox, &rays.oy, &rays.oz, &rays.dx, &rays.dy, &rays.dz, &rays.far})
      (*v)[to] = (*v)[from];
    ++to;
  }
  for (std::size_t i = 0; i < rays.valid.size(); ++i) rays.valid[i] = i < to ? -1 : 0;
  rays.tiles = (to + tile_rays - 1) / tile_rays;
}

template <class Pixel>
void for_each_place(ImageSize size, const Pixel& pixel) {
  const TileGrid grid{size};
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const std::size_t tile =
          static_cast<std::size_t>(y / 16) * grid.columns() + static_cast<std::size_t>(x / 16);
      pixel(x, y, tile * tile_rays + tile_lane(x % 16, y % 16));
    }
}

template <class Packet>
void load(const PeerRays& r, std::size_t at, Packet& p) {
  constexpr std::size_t bytes = 16 * sizeof(float);
  std::memcpy(p.org_x, &r.ox[at], bytes), std::memcpy(p.org_y, &r.oy[at], bytes);
  std::memcpy(p.org_z, &r.oz[at], bytes), std::memcpy(p.dir_x, &r.dx[at], bytes);
  std::memcpy(p.dir_y, &r.dy[at], bytes), std::memcpy(p.dir_z, &r.dz[at], bytes);
  std::memcpy(p.tfar, &r.far[at], bytes);
  for (std::size_t i = 0; i < 16; ++i) p.tnear[i] = 0.0f, p.time[i] = 0.0f, p.mask[i] = 0xffffffffu;
}

void load_one(const PeerRays& r, std::size_t at, RTCRay& p) {
  p = {};
  p.org_x = r.ox[at], p.org_y = r.oy[at], p.org_z = r.oz[at];
  p.dir_x = r.dx[at], p.dir_y = r.dy[at], p.dir_z = r.dz[at];
  p.tfar = r.far[at], p.mask = 0xffffffffu;
}

template <class Tile>
void for_each_tile(std::size_t tiles, const Tile& tile) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, tiles, 1), [&](const auto& r) {
    for (std::size_t i = r.begin(); i != r.end(); ++i) tile(i * tile_rays);
  });
}

void prepare(const PeerRays& rays, PeerHits& hits) {
  const std::size_t n = rays.tiles * tile_rays;
  if (hits.t.size() == n) return;
  hits.t.resize(n), hits.u.resize(n), hits.v.resize(n), hits.primitive.resize(n);
}

}  // namespace

PeerRays primary_rays(const View& view) {
  PeerRays rays = empty_rays(view.size);
  for_each_place(view.size, [&](int x, int y, std::size_t at) {
    const Ray ray = pixel_ray(view, x + 0.5, y + 0.5);
    put(rays, at, ray.origin, ray.direction, infinity);
  });
  return rays;
}

PeerRays shadow_rays(const raytrace::RayTracedFrame& frame, const Light& light, double scale) {
  PeerRays rays = empty_rays(frame.receiver.size);
  for_each_place(frame.receiver.size, [&](int x, int y, std::size_t at) {
    const raytrace::SurfacePoint& p = frame.receiver.at(x, y);
    if (p.primitive == no_id || light_cannot_reach(light, p.position, p.normal)) return;
    const Vec3 origin = p.position + 0x1p-14 * scale * p.normal;
    if (light.type == LightType::directional)
      put(rays, at, origin, -light.direction, infinity);
    else
      put(rays, at, origin, light.position - origin, 1.0 - 0x1p-20);
  });
  return rays;
}

PeerRays mirror_rays(const raytrace::RayTracedFrame& frame, const View& view, double scale) {
  PeerRays rays = empty_rays(frame.receiver.size);
  for_each_place(frame.receiver.size, [&](int x, int y, std::size_t at) {
    const raytrace::SurfacePoint& p = frame.receiver.at(x, y);
    if (p.primitive == no_id) return;
    const Vec3 d = pixel_ray(view, x + 0.5, y + 0.5).direction;
    put(rays, at, p.position + 0x1p-14 * scale * p.normal, d - 2.0 * glm::dot(d, p.normal) * p.normal,
        infinity);
  });
  close_up(rays);
  return rays;
}

Embree::Embree(const World& world, const std::string& settings)
    : bytes_(std::make_unique<std::atomic<ssize_t>>(0)),
      device_(rtcNewDevice(settings.c_str())),
      scene_(rtcNewScene(device_)) {
  rtcSetDeviceMemoryMonitorFunction(
      device_,
      [](void* sum, ssize_t bytes, bool) {
        *static_cast<std::atomic<ssize_t>*>(sum) += bytes;
        return true;
      },
      bytes_.get());
  rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_MEDIUM);
  if (world.keeps_instances())
    add_instances(world);
  else
    attach(scene_, triangles(positions_of(world), triangles_of(world)));
  rtcCommitScene(scene_);
}
Embree::~Embree() {
  rtcReleaseScene(scene_);
  for (const auto& [mesh, scene] : meshes_) rtcReleaseScene(scene);
  rtcReleaseDevice(device_);
}

void Embree::attach(RTCScene scene, RTCGeometry geometry) const {
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
}

RTCGeometry Embree::triangles(std::span<const Vec3> positions,
                              std::span<const std::array<std::uint32_t, 3>> triangles) const {
  RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* v = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), positions.size()));
  for (const Vec3& p : positions)
    for (int a = 0; a < 3; ++a) *v++ = static_cast<float>(p[a]);
  auto* t = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), triangles.size()));
  std::memcpy(t, triangles.data(), triangles.size_bytes());
  return geometry;
}

/// A scene for each mesh that is kept, and the instances of it; what is flattened besides.
void Embree::add_instances(const World& world) {
  for (const WorldPart& part : world.parts) {
    if (!part.kept()) {
      attach(scene_, triangles({part.positions, part.vertex_count()}, part.mesh->triangles));
      continue;
    }
    const auto [known, is_new] = meshes_.try_emplace(part.mesh);
    if (is_new) {
      known->second = rtcNewScene(device_);
      rtcSetSceneBuildQuality(known->second, RTC_BUILD_QUALITY_MEDIUM);
      attach(known->second, triangles(part.mesh->positions, part.mesh->triangles));
      rtcCommitScene(known->second);
    }
    RTCGeometry instance = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(instance, known->second);
    std::array<float, 12> columns{};
    for (std::size_t i = 0; i < columns.size(); ++i)
      columns[i] =
          static_cast<float>(part.world_from_object[static_cast<int>(i / 3)][static_cast<int>(i % 3)]);
    rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns.data());
    attach(scene_, instance);
  }
}

void Embree::closest_single(const PeerRays& rays, PeerHits& hits) const {
  prepare(rays, hits);
  for_each_tile(rays.tiles, [&](std::size_t first) {
    test::EmbreeQuery coherent(true);
    for (std::size_t at = first; at < first + tile_rays; ++at) {
      hits.primitive[at] = RTC_INVALID_GEOMETRY_ID;
      if (rays.valid[at] == 0) continue;
      RTCRayHit query;
      load_one(rays, at, query.ray);
      query.hit.primID = query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      test::embree_intersect(scene_, coherent, query);
      hits.t[at] = query.ray.tfar, hits.u[at] = query.hit.u, hits.v[at] = query.hit.v;
      hits.primitive[at] = query.hit.primID;
    }
  });
}

void Embree::closest_packets(const PeerRays& rays, PeerHits& hits) const {
  prepare(rays, hits);
  for_each_tile(rays.tiles, [&](std::size_t first) {
    test::EmbreeQuery coherent(true);
    RTCRayHit16 query;
    for (std::size_t at = first; at < first + tile_rays; at += 16) {
      load(rays, at, query.ray);
      for (std::size_t i = 0; i < 16; ++i)
        query.hit.primID[i] = query.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
      alignas(64) int valid[16];
      std::memcpy(valid, &rays.valid[at], sizeof valid);
      test::embree_intersect(valid, scene_, coherent, query);
      std::memcpy(&hits.t[at], query.ray.tfar, sizeof valid),
          std::memcpy(&hits.u[at], query.hit.u, sizeof valid);
      std::memcpy(&hits.v[at], query.hit.v, sizeof valid);
      std::memcpy(&hits.primitive[at], query.hit.primID, sizeof valid);
    }
  });
}

void Embree::occluded_single(const PeerRays& rays, std::vector<std::uint8_t>& occluded) const {
  occluded.resize(rays.tiles * tile_rays);
  for_each_tile(rays.tiles, [&](std::size_t first) {
    test::EmbreeQuery coherent(true);
    for (std::size_t at = first; at < first + tile_rays; ++at) {
      occluded[at] = 0;
      if (rays.valid[at] == 0) continue;
      RTCRay query;
      load_one(rays, at, query);
      test::embree_occluded(scene_, coherent, query);
      occluded[at] = query.tfar < 0.0f ? 1 : 0;
    }
  });
}

void Embree::occluded_packets(const PeerRays& rays, std::vector<std::uint8_t>& occluded) const {
  occluded.resize(rays.tiles * tile_rays);
  for_each_tile(rays.tiles, [&](std::size_t first) {
    test::EmbreeQuery coherent(true);
    RTCRay16 query;
    for (std::size_t at = first; at < first + tile_rays; at += 16) {
      alignas(64) int valid[16];
      std::memcpy(valid, &rays.valid[at], sizeof valid);
      if (std::all_of(valid, valid + 16, [](int v) { return v == 0; })) {
        std::fill_n(&occluded[at], 16, std::uint8_t{0});
        continue;
      }
      load(rays, at, query);
      test::embree_occluded(valid, scene_, coherent, query);
      for (std::size_t i = 0; i < 16; ++i)
        occluded[at + i] = rays.valid[at + i] != 0 && query.tfar[i] < 0.0f ? 1 : 0;
    }
  });
}

}  // namespace gnomon::bench
