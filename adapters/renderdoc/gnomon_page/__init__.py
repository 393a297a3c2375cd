"""Records a frame with shadows of a web page: Chromium draws it on Mesa's software Vulkan, where RenderDoc's layer records it."""
