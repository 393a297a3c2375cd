// A mask that stands in a file of its own, beside the colours that it cuts out.
#pragma once

#include "scene/scene.h"

namespace gnomon {

/// Makes alpha the luminance of the stored values (ITU-R BT.709's weights), as MTL's -imfchan l does. Of a grey texel
/// it is the grey.
void take_alpha_from_luminance(Texture& mask);

/// The colours of one texture with the alpha of the other, both wrapped as `colours` is. Where they have different
/// sizes, at the larger width and the larger height of the two: a texel then is what the lookup (texture_sample.h)
/// gives at its centre.
Texture with_alpha_of(Texture colours, Texture mask);

}  // namespace gnomon
