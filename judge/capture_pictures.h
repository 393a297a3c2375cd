// The pictures that a capture names, read and checked: visibility, and where the capture says them the places
// that its pixels show.
#pragma once

#include <span>

#include "judge/capture.h"
#include "scene/files/pictures/image_io.h"

namespace gnomon::judge {

/// Images are of the capture's size, row 0 at the top.
struct CapturedPictures {
  Image<float> visibility;      ///< in [0, 1]; 1 where `reached` is 0
  Image<std::uint8_t> reached;  ///< 1 where the light arrives without shadows, as far as the pictures tell
  /// 1 where something was drawn. Empty: the pictures do not tell.
  Image<std::uint8_t> drawn;
  bool ratio = false;        ///< visibility is shadowed over unshadowed
  bool other_light = false;  ///< of a ratio: both pictures hold light of something else (other_light.h)
  bool eight_bits = false;   ///< of a ratio: all numbers are multiples of 1/255
  /// Counts, for a ratio, pixels where the picture with shadows is clearly brighter or darker than the one without.
  std::size_t brighter = 0, darker = 0;
  ColorImage color;  ///< linear; grey where the capture has no colours; of a ratio the picture with shadows
  ColorImage unshadowed;  ///< of a ratio
  Image<float> also;      ///< what else darkens the picture; empty: nothing
  /// Depth along the camera's forward axis or distance, whichever the capture gives, or positions; one of
  /// them or none is not empty. 0 where nothing was drawn.
  Image<Vec3> position;
  Image<double> depth;
  bool depth_is_distance = false;
};

/// Reads the headers of all pictures and layers that the capture names, before anything is decoded. They must be there, and
/// pictures must have the capture's size. The faces of a cube must be square and of one size, and a layer must lie within its
/// picture. Errors (bad input) name picture and field.
Expected<void> check_picture_sizes(const Capture& capture);

/// The size of a layer's picture, by its header.
Expected<ImageSize> layer_picture_size(const Capture& capture, std::size_t layer);
/// The size of the layer itself: its rect, or all of its picture.
Expected<ImageSize> layer_size(const Capture& capture, std::size_t layer);

/// Errors (bad input) name picture and field. A file is missing, is of another size, has more channels than wanted, or has
/// values that are not finite or not in their range. `orthographic`: the camera, whose depth buffer goes evenly from near to
/// far.
Expected<CapturedPictures> read_pictures(const Capture& capture, bool orthographic);

/// Divides the visibility by what else darkens the picture. Where that leaves next to nothing the picture does not tell.
void divide_by_also(CapturedPictures& pictures);

/// All channels of a layer's picture.
Expected<ChannelImage> read_layer(const Capture& capture, std::size_t layer);

/// The one channel of a layer's picture, Z, Y, R or V; `size` becomes the picture's.
Expected<Channel> read_layer_numbers(const Capture& capture, std::size_t layer, ImageSize& size);

/// One channel of a picture by the first of these names, or its only one. `field`: for messages.
Expected<Channel> read_single_channel(const Capture& capture, const std::string& file,
                                      const std::string& field, std::span<const std::string_view> names,
                                      ImageSize& size);

}  // namespace gnomon::judge
