import { defineConfig } from "vite";

export default defineConfig({
  base: "./", // works from any static folder
  worker: { format: "es" },
  server: { fs: { allow: ["../.."] } },
  build: { target: "es2022", chunkSizeWarningLimit: 1200, assetsInlineLimit: 0 },
});
