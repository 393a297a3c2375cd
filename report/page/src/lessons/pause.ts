/** Lets the page do what else there is, keys and pictures, before long work goes on. */
export const pause = (): Promise<void> => new Promise((done) => setTimeout(done));
