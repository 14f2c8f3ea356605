    // The bus: an AXI4-Lite master. A handshake is looked at before the rising edge of the clock, and its end made after it.
    localparam integer ACCESS_CYCLES_MAX = {{ access_cycles_max }};
    reg awvalid, wvalid, bready, arvalid, rready;
    reg [12:0] awaddr, araddr;
    reg [31:0] wdata;
    reg [3:0] wstrb;
    reg [1:0] want_bresp;
    integer ends_b, ends_r; // answers that were taken
    wire awready, wready, bvalid, arready, rvalid;
    wire [1:0] bresp, rresp;
    wire [31:0] rdata;
    reg answered;

    task host_idle;
        begin
            awvalid = 1'b0;
            wvalid = 1'b0;
            bready = 1'b0;
            arvalid = 1'b0;
            rready = 1'b0;
            awaddr = 13'd0;
            araddr = 13'd0;
            wdata = 32'd0;
            wstrb = 4'b1111;
            want_bresp = 2'd0;
        end
    endtask

    task clock_edge;
        reg aw, w, b, ar, r;
        begin
            @(negedge clk);
            aw = awvalid & awready;
            w = wvalid & wready;
            b = bready & bvalid;
            ar = arvalid & arready;
            r = rready & rvalid;
            if (b)
                check("bresp", {46'd0, bresp}, {46'd0, want_bresp});
            if (r) begin
                check("rresp", {46'd0, rresp}, 48'd0);
                answer = rdata;
            end
            @(posedge clk);
            #(CLK_NS / 4.0);
            if (aw)
                awvalid = 1'b0;
            if (w)
                wvalid = 1'b0;
            if (ar)
                arvalid = 1'b0;
            answered = answered | b | r;
            ends_b = ends_b + b;
            ends_r = ends_r + r;
        end
    endtask

    task transfer(input write, input [31:0] address, input [31:0] value);
        integer k;
        begin
            @(posedge clk);
            #(CLK_NS / 4.0);
            // The direction that is not meant has another address.
            awaddr = {address[10:0] ^ {11{~write}}, 2'b00};
            araddr = {address[10:0] ^ {11{write}}, 2'b00};
            wdata = value;
            awvalid = write;
            wvalid = write;
            bready = write;
            arvalid = ~write;
            rready = ~write;
            answered = 1'b0;
            for (k = 0; k < ACCESS_CYCLES_MAX && !answered; k = k + 1)
                clock_edge;
            check("answer on the bus", {47'd0, answered}, 48'd1);
            host_idle;
        end
    endtask

    // Until an answer has been taken, or for so long.
    task wait_answer;
        integer k;
        begin
            answered = 1'b0;
            for (k = 0; k < ACCESS_CYCLES_MAX && !answered; k = k + 1)
                clock_edge;
            check("answer on the bus", {47'd0, answered}, 48'd1);
        end
    endtask

    task offer(input [31:0] value);
        begin
            awaddr = {CARD_CONFIG_HOLD[10:0], 2'b00};
            wdata = value;
            awvalid = 1'b1;
            wvalid = 1'b1;
        end
    endtask

    // Address and data in either order, answers that are not taken at once, parts of words; at the word that is free for the host.
    task bus_limits;
        begin
            host_idle;
            @(posedge clk);
            #(CLK_NS / 4.0);
            offer(32'hA1B2C300);
            awvalid = 1'b0;
            bready = 1'b1;
            answered = 1'b0;
            repeat (ACCESS_CYCLES_MAX)
                clock_edge;
            check("answer to a word without address", {47'd0, answered}, 48'd0);
            awvalid = 1'b1;
            wait_answer;
            host_idle;
            transfer(1'b0, CARD_CONFIG_HOLD, 32'd0);
            check("word before its address", answer, 32'hA1B2C300);
            offer(32'h4D5E6F00);
            wvalid = 1'b0;
            bready = 1'b1;
            answered = 1'b0;
            repeat (ACCESS_CYCLES_MAX)
                clock_edge;
            check("answer to an address without word", {47'd0, answered}, 48'd0);
            wvalid = 1'b1;
            wait_answer;
            host_idle;
            transfer(1'b0, CARD_CONFIG_HOLD, 32'd0);
            check("word after its address", answer, 32'h4D5E6F00);
            // A write whose answer is not taken: the next one waits, reads go on.
            offer(32'h11223300);
            repeat (ACCESS_CYCLES_MAX)
                clock_edge;
            check("bvalid while bready is low", {47'd0, bvalid}, 48'd1);
            offer(32'h44556600);
            repeat (ACCESS_CYCLES_MAX)
                clock_edge;
            araddr = {CARD_CONFIG_HOLD[10:0], 2'b00};
            arvalid = 1'b1;
            rready = 1'b1;
            wait_answer;
            check("word while a write waits", answer, 32'h11223300);
            rready = 1'b0;
            check("bvalid is held", {47'd0, bvalid}, 48'd1);
            ends_b = 0;
            bready = 1'b1;
            repeat (2 * ACCESS_CYCLES_MAX)
                clock_edge;
            check("answers to two writes", ends_b, 2);
            host_idle;
            transfer(1'b0, CARD_CONFIG_HOLD, 32'd0);
            check("word of the second write", answer, 32'h44556600);
            // A read whose answer is not taken: it is held, and the next one waits; writes go on.
            araddr = {CARD_CONFIG_HOLD[10:0], 2'b00};
            arvalid = 1'b1;
            repeat (ACCESS_CYCLES_MAX)
                clock_edge;
            check("rvalid while rready is low", {47'd0, rvalid}, 48'd1);
            araddr = {CARD_ID[10:0], 2'b00};
            arvalid = 1'b1;
            offer(32'h77889900);
            bready = 1'b1;
            wait_answer;
            bready = 1'b0;
            repeat (ACCESS_CYCLES_MAX)
                clock_edge;
            check("rdata is held", rdata, 32'h44556600);
            ends_r = 0;
            rready = 1'b1;
            repeat (2 * ACCESS_CYCLES_MAX)
                clock_edge;
            check("answers to two reads", ends_r, 2);
            host_idle;
            transfer(1'b0, CARD_ID, 32'd0);
            check("word of the second read", rdata, answer);
            // A part of a word is refused; none of it is nothing to do.
            offer(32'hFFFFFF00);
            wstrb = 4'b0111;
            want_bresp = 2'd2;
            bready = 1'b1;
            wait_answer;
            host_idle;
            offer(32'hFFFFFF00);
            wstrb = 4'b0000;
            bready = 1'b1;
            wait_answer;
            host_idle;
            transfer(1'b0, CARD_CONFIG_HOLD, 32'd0);
            check("word after refused writes", answer, 32'h77889900);
            transfer(1'b1, CARD_CONFIG_HOLD, 32'd0);
        end
    endtask
