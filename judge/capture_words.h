// What unknown keys of captures most likely mean.
#pragma once

#include "scene/files/json/json_reader.h"

namespace gnomon::judge {

/// Words of engines and of earlier captures for what the format says elsewhere.
inline constexpr KeyMeaning capture_words[] = {
    {"cascades", "map[].select"},
    {"splits", "map[].select"},
    {"cascadesplits", "map[].select"},
    {"splitdistances", "map[].select"},
    {"atlas", "map[].rect"},
    {"viewport", "map[].rect"},
    {"matrix", "map[].clip_from_world"},
    {"lightmatrix", "map[].clip_from_world"},
    {"viewprojection", "map[].clip_from_world"},
    {"shadowmatrix", "map[].clip_from_world"},
    {"near", "map[].range"},
    {"far", "map[].range"},
    {"constant", "bias.constant_depth"},
    {"constantbias", "bias.constant_depth"},
    {"depthbias", "bias.constant_depth"},
    {"shadowbias", "bias.constant_depth"},
    {"slopebias", "bias.slope"},
    {"slopescale", "map[].caster_bias.slope"},
    {"polygonoffset", "map[].caster_bias"},
    {"normalbias", "bias.normal_offset_world"},
    {"normaloffset", "bias.normal_offset_world"},
    {"radius", "filter.radius_texels"},
    {"kernel", "filter.kind"},
    {"opacity", "strength"},
    {"intensity", "strength"},
    {"darkness", "strength"},
    {"maxdistance", "fade"},
    {"shadowdistance", "fade"},
    {"contactshadows", "also"},
    {"cookie", "also"},
    {"mask", "also"},
    {"shadow", "visibility"},
    {"shadows", "visibility"},
    {"positions", "position"},
};

}  // namespace gnomon::judge
