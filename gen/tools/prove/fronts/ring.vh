// ring_is_home: Between accesses the ring of configuration words is in its start position.
// begins_at_home: An access begins with the ring in its start position, whatever the front does.
    // Everything that a front can say is free, and changes in every cycle. Bytes that the ring has moved on, up to a whole turn.
    reg [8:0] f_steps = 0;
    localparam [8:0] WHOLE = 12 * BLOCKS;
    wire [8:0] f_next = f_steps + ring_turn;
    wire [8:0] f_counted = 12 * block_at + byte_at;
    always @* assume (!reset);
    always @(posedge clock) f_steps <= (f_next == WHOLE) ? 0 : f_next;
    always @* begin
        // Between accesses the ring is where it was.
        if (!turning && !turn) begin ring_is_home: assert (f_steps == 0); end
        if (starts) begin begins_at_home: assert (f_next == 0 || f_next == WHOLE); end
    end
    // What holds between front, word and bank in every state that can be reached; the counters run one step ahead of the ring.
    always @* begin
        place_is_real: assert (byte_at <= 11 && (block_at < BLOCKS || !turning));
        if (turning && whole_turn) begin place_is_known: assert (f_next == f_counted); end
        else begin home_otherwise: assert (f_next == 0 || f_next == WHOLE); end
        if (!turning && f_next == 0) begin at_rest: assert (f_steps == 0); end
    end
