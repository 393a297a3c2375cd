"""Makes captures for `gnomon judge` of frames that RenderDoc recorded, of any engine."""
