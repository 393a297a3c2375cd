// The program for the web in a worker of this page (gnomon_worker.mjs), by the files beside it or within the page.

export class ProgramWorker {
  private readonly open = new Map<number, (answer: Response) => void>();
  private last = 0;
  private gone: string | null = null;

  constructor(private readonly worker: Worker) {
    this.worker.onerror = (event) =>
      this.fail(event.message || "The program for the web cannot be loaded: its files are not beside this page.");
    this.worker.onmessage = ({
      data,
    }: MessageEvent<{ id?: number; gone?: string; status: number; type: string; body: Uint8Array<ArrayBuffer> }>) => {
      if (data.gone !== undefined || data.id === undefined) return this.fail(data.gone ?? "");
      this.open.get(data.id)?.(new Response(data.body, { status: data.status, headers: { "Content-Type": data.type } }));
      this.open.delete(data.id);
    };
  }

  private fail(words: string): void {
    this.gone = words;
    for (const answer of this.open.values()) answer(new Response(words, { status: 500 }));
    this.open.clear();
  }

  /** Its answer, like one over HTTP: words with status 500 where it has stopped. */
  async ask(name: string, parameters: object, body?: Blob | string): Promise<Response> {
    const bytes = body === undefined ? undefined : await new Response(body).arrayBuffer();
    return new Promise((answer) => {
      if (this.gone !== null) return answer(new Response(this.gone, { status: 500 }));
      this.open.set(++this.last, answer);
      this.worker.postMessage({ id: this.last, name, parameters, body: bytes }, bytes ? [bytes] : []);
    });
  }
}

/** The answer, or an error with its words. */
export async function answered(response: Response): Promise<Response> {
  if (response.ok) return response;
  const text = await response.text();
  let said = text.trim();
  try {
    said = (JSON.parse(text) as { error: string }).error;
  } catch {
    /* words, then */
  }
  throw new Error(said || `the program answers with ${response.status}`);
}
