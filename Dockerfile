# The command `harness` in a small image. The shipped scenarios are part of the program.
#
#   docker build --build-arg HARNESS_COMMIT=$(git rev-parse --short=10 HEAD) -t harness .
#   docker run --rm -v "$PWD:/work" harness run --name rendezvous-7

FROM rust:1.95-slim-bookworm AS build
ARG HARNESS_COMMIT=unknown
ENV HARNESS_COMMIT=${HARNESS_COMMIT}
WORKDIR /source
COPY . .
RUN cargo build --release --locked --bin harness && strip target/release/harness

FROM debian:bookworm-slim
COPY --from=build /source/target/release/harness /usr/local/bin/harness
COPY LICENSE-MIT LICENSE-APACHE /usr/share/doc/harness/
# Results belong to the user who owns the mounted folder: `docker run --user "$(id -u):$(id -g)"`.
RUN useradd --create-home harness
USER harness
WORKDIR /work
ENTRYPOINT ["harness"]
CMD ["--help"]
