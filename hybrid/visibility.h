// The hybrid renderer as the rasterizer's Technique::hybrid: sheets kept for every light that stands still,
// receivers from the visibility buffer, rays for what the sheets leave ambiguous.
#pragma once

#include <memory>

#include "raster/external_visibility.h"
#include "scene/world.h"

namespace gnomon::hybrid {

/// A light's sheets are made when it is first asked for; when it has moved since, once it has stood still for
/// long enough (Sheets::when_they_pay). Its own ray tracer is built when it is first asked. The lights are
/// read from the world's scene at each call, so they may move in between; the world must not change and must
/// outlive the result.
std::shared_ptr<raster::ExternalVisibility> make_visibility(const World& world);

}  // namespace gnomon::hybrid
