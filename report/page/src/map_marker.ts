// Where a pixel looks in the picture of the depth map (compare/result/pictures.cpp: faces three by three with a gap, rows upwards).
import type { Light, Pixel } from "./data";
import { html } from "./svg";

export class MapMarker {
  private readonly marker = html("div", { class: "map-marker" });
  private readonly side: number; // of a face, in pixels of the picture
  private readonly gap: number;
  private readonly across: number;
  private readonly width: number; // of the picture, in its pixels
  private readonly height: number;

  constructor(
    private readonly light: Light,
    image: HTMLImageElement,
  ) {
    this.width = Number(image.getAttribute("width"));
    this.height = Number(image.getAttribute("height"));
    const faces = light.json.view.faces.length;
    this.across = Math.min(faces, 3);
    const gapOf = (side: number) => (faces > 1 ? Math.max(1, Math.floor(side / 64)) : 0);
    let side = Math.floor(this.width / this.across);
    while (side > 1 && this.across * side + (this.across - 1) * gapOf(side) > this.width) --side;
    this.side = side;
    this.gap = gapOf(side);
    const frame = html("div", { class: "map-frame" });
    image.replaceWith(frame);
    frame.append(image, this.marker);
  }

  show(pixel: Pixel): void {
    const { size } = this.light.json.view,
      { u, v } = pixel.at;
    this.marker.hidden = !(pixel.seen && u >= 0 && v >= 0 && u < size && v < size); // of a pixel outside the map there is no place in it
    const scale = this.side / size;
    const x = (pixel.face % this.across) * (this.side + this.gap) + u * scale;
    const y = Math.floor(pixel.face / this.across) * (this.side + this.gap) + this.side - v * scale;
    this.marker.style.left = `${(100 * x) / this.width}%`;
    this.marker.style.top = `${(100 * y) / this.height}%`;
  }
}
