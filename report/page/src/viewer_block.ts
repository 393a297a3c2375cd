// The viewer's elements, hidden until it comes to life (viewer.ts).
import { markup, type Markup } from "./template";

/** `options`: of its menus; `id` sets its hint apart; `exposure`: with a slider for it. */
export const viewerBlock = (
  options: Markup | null,
  id: string | number,
  hint: Markup,
  exposure: boolean,
): Markup => markup`<div class="viewer" hidden>
<div class="viewer-bar" role="group" aria-label="Compare two pictures">
<label>Left <select class="pick">${options}</select></label> <label>Right <select class="pick">${options}</select></label>
<span class="modes" role="group" aria-label="How"><button type="button"
data-mode="swipe">Swipe</button><button type="button" data-mode="side">Side by side</button><button
type="button" data-mode="flip">Flip</button></span>
<span class="modes" role="group" aria-label="Zoom"><button type="button" data-zoom="out"
aria-label="Zoom out">−</button><output class="zoom-value">1×</output><button type="button" data-zoom="in"
aria-label="Zoom in">+</button><button type="button" data-zoom="fit">Fit</button></span>
<label class="exposure"${exposure ? "" : markup` hidden`}>Exposure <input type="range" min="-6" max="6" step="0.25" value="0"></label>
</div>
<div class="stage" tabindex="0" role="group" aria-label="Two pictures of the scene"
aria-describedby="hint-${id}"><div class="pane"><img alt=""><span class="tag"></span></div><div
class="pane"><img alt=""><span class="tag"></span></div><div class="divider"></div></div>
<label class="slider">Divider <input type="range" min="0" max="100" value="50"></label>
<p class="probe" role="status">Point at a pixel to read it.</p>
<p class="hint" id="hint-${id}">${hint}</p>
</div>
`;
