-- For man pages out of the reference: links become their text, the page's title goes, and tables become lists, since a
-- terminal is too narrow for them: the first cell names the entry, the others follow under their column's heading.
local titled = false

function Link(link) return link.content end

function Header(header)
  if header.level == 1 and not titled then
    titled = true
    return {}
  end
  header.level = math.max(1, header.level - 1)
  return header
end

local function cells_of(row)
  local cells = {}
  for _, cell in ipairs(row.cells) do cells[#cells + 1] = pandoc.utils.blocks_to_inlines(cell.contents) end
  return cells
end

function Table(tbl)
  local heads = tbl.head.rows[1] and cells_of(tbl.head.rows[1]) or {}
  local entries = {}
  for _, body in ipairs(tbl.bodies) do
    for _, row in ipairs(body.body) do
      local cells = cells_of(row)
      local texts = {}
      for i = 2, #cells do
        local text = pandoc.Inlines {}
        if #cells > 2 and heads[i] and #heads[i] > 0 then
          text:extend(heads[i])
          text:extend {pandoc.Str ":", pandoc.Space()}
        end
        text:extend(cells[i])
        if #cells[i] > 0 then texts[#texts + 1] = pandoc.Para(text) end
      end
      entries[#entries + 1] = {pandoc.Inlines {pandoc.Strong(cells[1])}, {texts}}
    end
  end
  return pandoc.DefinitionList(entries)
end
