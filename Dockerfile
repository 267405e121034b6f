# The program in a container, without a screen: docker build -t belvedere .
# Files of the current folder: docker run --rm -u "$(id -u)" -v "$PWD:/data" belvedere info tile.laz
FROM rust:1-slim AS build
WORKDIR /source
COPY . .
RUN cargo install --locked --path crates/belvedere-cli --root /installed

FROM debian:stable-slim
COPY --from=build /installed/bin/belvedere /usr/local/bin/belvedere
# kept scenes: give a volume to keep them between runs
ENV XDG_CACHE_HOME=/tmp
WORKDIR /data
ENTRYPOINT ["belvedere"]
