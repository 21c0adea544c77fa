# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
#
# The tools alone, in a small image:
#
#   docker build -t excavplan .
#   docker run --rm --user "$(id -u):$(id -g)" -v "$PWD:/work" excavplan estimate-density before.pcd after.pcd
FROM debian:bookworm-slim AS build
WORKDIR /source
COPY . .
RUN EXCAVPLAN_FAST_INSTALL=1 SOURCE_DATE_EPOCH=0 scripts/packages /packages

FROM debian:bookworm-slim
COPY --from=build /packages/excavplan_*.deb /tmp/
RUN apt-get update -qq && \
    DEBIAN_FRONTEND=noninteractive apt-get install -qq --no-install-recommends \
      -o Dpkg::Options::=--force-unsafe-io /tmp/excavplan_*.deb fonts-dejavu-core >/dev/null && \
    rm -rf /var/lib/apt/lists/* /tmp/*.deb && \
    useradd --create-home user
USER user
WORKDIR /work
CMD ["plan-path", "--help"]
