// What a page runs before its own scripts. It counts what the page draws, and switches multisampling and WebGPU off. Once it is armed it
// stops the page before the next draw into a framebuffer with depth: a frame's shadow map comes first.
(() => {
  const seen = { contexts: 0, draws: 0, depths: 0, antialias: false, samples: false, webgpu: false };
  let isArmed = false;
  const stop = () => {
    isArmed = false;
    debugger;
  };
  globalThis.gnomon = { seen, arm: () => (isArmed = true), disarm: () => (isArmed = false) };

  const bound = new WeakMap(); // context -> framebuffer
  const deep = new WeakSet(); // framebuffers with depth
  const wrap = (methods, name, before) => {
    const method = methods[name];
    if (!method) return;
    methods[name] = function (...words) {
      before(this, words);
      return method.apply(this, words);
    };
  };
  const draw = (context) => {
    ++seen.draws;
    if (!deep.has(bound.get(context))) return;
    ++seen.depths;
    if (isArmed) stop();
  };
  const attach = (context, [, attachment]) => {
    if ((attachment === 0x8d00 || attachment === 0x821a) && bound.get(context)) deep.add(bound.get(context)); // DEPTH, DEPTH_STENCIL
  };
  for (const kind of [globalThis.WebGLRenderingContext, globalThis.WebGL2RenderingContext]) {
    if (!kind) continue;
    wrap(kind.prototype, "bindFramebuffer", (context, [target, framebuffer]) => target === 0x8ca8 || bound.set(context, framebuffer)); // READ
    for (const name of ["framebufferTexture2D", "framebufferTextureLayer", "framebufferRenderbuffer"]) wrap(kind.prototype, name, attach);
    for (const name of ["drawArrays", "drawElements", "drawArraysInstanced", "drawElementsInstanced", "drawRangeElements"])
      wrap(kind.prototype, name, draw);
    wrap(kind.prototype, "renderbufferStorageMultisample", (context, words) => {
      seen.samples ||= words[1] > 1;
      words[1] = 0;
    });
  }
  // An extension's own draws.
  const extended = ["drawArraysInstancedANGLE", "drawElementsInstancedANGLE", "multiDrawArraysWEBGL", "multiDrawElementsWEBGL"];
  extended.push("multiDrawArraysInstancedWEBGL", "multiDrawElementsInstancedWEBGL");
  for (const kind of [globalThis.WebGLRenderingContext, globalThis.WebGL2RenderingContext]) {
    if (!kind) continue;
    const get = kind.prototype.getExtension;
    kind.prototype.getExtension = function (name) {
      const extension = get.call(this, name);
      for (const method of extended) {
        const call = extension?.[method];
        if (call && !Object.hasOwn(extension, method)) extension[method] = (...words) => (draw(this), call.apply(extension, words));
      }
      return extension;
    };
  }
  for (const canvas of [globalThis.HTMLCanvasElement, globalThis.OffscreenCanvas]) {
    if (!canvas) continue;
    const get = canvas.prototype.getContext;
    const known = new WeakSet();
    canvas.prototype.getContext = function (kind, options) {
      if (!/webgl/.test(kind)) return get.apply(this, arguments);
      seen.antialias ||= options?.antialias !== false;
      const context = get.call(this, kind, { ...options, antialias: false });
      if (context && !known.has(context)) {
        known.add(context);
        ++seen.contexts;
      }
      return context;
    };
  }
  if (globalThis.navigator && "gpu" in navigator)
    Object.defineProperty(Object.getPrototypeOf(navigator), "gpu", {
      get() {
        seen.webgpu = true;
        return undefined;
      },
    });

  // Shows something new, so that the window is presented; all of the page's windows may be told of a new size, for which pages draw anew
  // that draw on demand.
  let spot = null;
  gnomon.show = () => {
    spot ??= document.createElement("div");
    spot.style.cssText = "position:fixed;left:0;top:0;width:2px;height:2px;z-index:2147483647;pointer-events:none";
    spot.style.background = (spot.isOdd = !spot.isOdd) ? "#000" : "#010101";
    if (!spot.isConnected) document.documentElement?.append(spot);
  };
  gnomon.resize = () => {
    for (const one of [globalThis, ...Array.from({ length: globalThis.length }, (_, i) => globalThis[i])]) {
      try {
        one.dispatchEvent(new Event("resize"));
      } catch {} // of another origin
    }
  };
})();
