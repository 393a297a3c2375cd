# Gnomon in a container, for jobs that compare scenes without a display: docker build -t gnomon . && docker run --rm
# -v "$PWD:/work" gnomon compare scene.json -o report. docs/ci.md has a workflow that uses it.
FROM debian:bookworm-slim AS build
RUN apt-get update && apt-get install -y --no-install-recommends ca-certificates dpkg-dev git
COPY . /gnomon
WORKDIR /gnomon
RUN ./gnomon build && cpack --config build/release/CPackConfig.cmake -B /package

FROM debian:bookworm-slim
COPY --from=build /package/gnomon_*.deb /tmp/
RUN apt-get update && apt-get install -y --no-install-recommends /tmp/gnomon_*.deb \
  && rm -rf /tmp/gnomon_*.deb /var/lib/apt/lists/*
WORKDIR /work
ENTRYPOINT ["gnomon"]
